// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/calibration_file.h"

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

}  // namespace mgtd::daemon::cli
