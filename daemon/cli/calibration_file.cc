// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/calibration_file.h"

#include <fmt/format.h>

#include "calib/poses/pose_columns.h"
#include "daemon/cli/command.h"

namespace mgtd::daemon::cli {

Result<calib::calibration::Calibration> read_calibration(const std::string& path) {
  const auto text = read_file(path);
  if (!text) return tl::unexpected(text.error());
  auto calibration = calib::calibration::calibration_from_json_text(*text);
  if (!calibration) {
    Error error = calibration.error();
    error.message = path + ": " + error.message;
    return tl::unexpected(std::move(error));
  }
  return calibration;
}

Result<calib::calibration::Calibration> calibration_of(const std::string& path, const FitFlags& flags) {
  const auto text = read_file(path);
  if (!text) return tl::unexpected(text.error());
  if (const auto first = text->find_first_not_of(" \t\r\n");
      first != std::string::npos && (*text)[first] == '{')
    return read_calibration(path);
  const auto source = store::read_run(path);
  if (!source) return tl::unexpected(source.error());
  const auto options = fit_options(flags, *source);
  if (!options) return tl::unexpected(options.error());
  auto fitted = calib::fit::method_choice::fit(source->table, *options);
  if (!fitted) {
    Error error = fitted.error();
    error.message = path + ": " + error.message;
    return tl::unexpected(std::move(error));
  }
  return std::move(fitted->calibration);
}

Result<void> same_sensors(const calib::calibration::Calibration& calibration, const std::string& file,
                          const PoseTable& table) {
  const std::size_t sensors = calib::poses::sensors_of(table);
  if (calibration.sensors.size() == sensors) return {};
  return fail(ErrorCode::bad_input,
              fmt::format("{} is the calibration of {}, and {} has readings of {}", file,
                          calib::poses::counted(calibration.sensors.size()), table.source,
                          calib::poses::counted(sensors)),
              "name a calibration of the array that was read");
}

}  // namespace mgtd::daemon::cli
