// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/calibration_file.h"

#include <fmt/format.h>

#include "calib/poses/pose_columns.h"
#include "daemon/cli/command.h"
#include "daemon/store/run_file.h"

namespace mgtd::daemon::cli {
namespace {

/// Told by content, or where there is none by the name.
Result<bool> is_calibration(const std::string& path) {
  const auto text = read_file(path);
  if (!text) return tl::unexpected(text.error());
  const auto first = text->find_first_not_of(" \t\r\n");
  if (first == std::string::npos) return path.ends_with(".json");
  return (*text)[first] == '{';
}

/// Of a CAL.json or a run file; empty for a pose table.
Result<std::optional<calib::sensor::Geometry>> places_in(const std::string& path) {
  if (store::is_run_file(path)) {
    const auto run = store::RunFile::open(path, store::Access::read_only);
    if (!run) return tl::unexpected(run.error());
    return std::optional(run->header().options.geometry);
  }
  const auto calibrated = is_calibration(path);
  if (!calibrated) return tl::unexpected(calibrated.error());
  if (!*calibrated) return std::nullopt;
  const auto calibration = read_calibration(path);
  if (!calibration) return tl::unexpected(calibration.error());
  return std::optional(calibration->geometry);
}

}  // namespace

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
  const auto calibrated = is_calibration(path);
  if (!calibrated) return tl::unexpected(calibrated.error());
  if (*calibrated) return read_calibration(path);
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

Result<FitFlags> with_places_of(const std::vector<std::string>& files, FitFlags flags) {
  for (const std::string& path : files) {
    const auto places = places_in(path);
    if (!places) return tl::unexpected(places.error());
    if (!*places) continue;
    flags.known_places = *places;
    break;
  }
  return flags;
}

Result<void> same_array(const calib::calibration::Calibration& calibration, const std::string& file,
                        const store::PoseSource& source) {
  const std::size_t sensors = calib::poses::sensors_of(source.table);
  if (calibration.sensors.size() != sensors)
    return fail(ErrorCode::bad_input,
                fmt::format("{} is the calibration of {}, and {} has readings of {}", file,
                            calib::poses::counted(calibration.sensors.size()), source.table.source,
                            calib::poses::counted(sensors)),
                "name a calibration of the array that was read");
  if (!source.header) return {};
  return store::same_array({file, calibration.geometry},
                           {source.table.source, source.header->options.geometry},
                           "name a calibration of the array that was read; if the places of the run file are "
                           "wrong, mgt export writes its poses without them");
}

Result<void> continues(const store::PlacedFile& first, const calib::calibration::Calibration& calibration,
                       const std::string& file) {
  if (calibration.reference.t_utc.empty())
    return fail(ErrorCode::bad_input, fmt::format("{} does not say when it was measured", file),
                "the column t_utc of a pose table says it (docs/pose-table.md)");
  return store::same_array(first, {file, calibration.geometry}, "compare calibrations of one array");
}

}  // namespace mgtd::daemon::cli
