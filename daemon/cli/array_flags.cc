// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/array_flags.h"

#include <fmt/format.h>

#include "calib/poses/pose_columns.h"
#include "daemon/cli/command.h"
#include "daemon/cli/in_range.h"
#include "daemon/config/array_places.h"

namespace mgtd::daemon::cli {

void add_array_flags(CLI::App* command, ArrayFlags& flags) {
  CLI::Option* const baseline =
      command->add_option("--baseline", flags.baseline_m, "distance between opposite sensors in m (0.4)")
          ->check(in_range(0.05, 10, "m"));
  command
      ->add_option("--array", flags.array,
                   "FILE.toml with the places of the sensors: [array] positions_m = [[x, y, z], ...], in m")
      ->excludes(baseline);
}

Result<std::optional<calib::sensor::Geometry>> array_of(const ArrayFlags& flags) {
  if (flags.baseline_m) return std::optional(calib::sensor::Geometry(*flags.baseline_m));
  if (flags.array.empty()) return std::optional<calib::sensor::Geometry>();
  const auto text = read_file(flags.array);
  if (!text) return tl::unexpected(text.error());
  const auto geometry = config::array_from_text(*text, flags.array);
  if (!geometry) return tl::unexpected(geometry.error());
  return std::optional(*geometry);
}

Result<calib::sensor::Geometry> array_for(const ArrayFlags& flags, std::size_t sensors,
                                          const std::string& table,
                                          const std::optional<calib::sensor::Geometry>& kept) {
  const auto given = array_of(flags);
  if (!given) return tl::unexpected(given.error());
  if (*given && (*given)->sensors() == sensors) return **given;
  if (flags.baseline_m)
    return fail(ErrorCode::bad_input,
                fmt::format("--baseline is of the cross of 4 sensors, and {} has readings of {}", table,
                            calib::poses::counted(sensors)),
                "give the places of all its sensors with --array FILE.toml");
  if (*given)
    return fail(
        ErrorCode::bad_input,
        fmt::format("{} has the places of {}, and {} has readings of {}", flags.array,
                    calib::poses::counted((*given)->sensors()), table, calib::poses::counted(sensors)),
        "give a place for every sensor, in the order s1, s2, ...");
  if (kept && kept->sensors() == sensors) return *kept;
  if (sensors == kSensorCount) return calib::sensor::Geometry();
  if (sensors == 1)
    return calib::sensor::Geometry(PerSensor<Eigen::Vector3d>{Eigen::Vector3d(Eigen::Vector3d::Zero())});
  return fail(
      ErrorCode::bad_input,
      fmt::format("{} has readings of {}, and where they stand is not known", table,
                  calib::poses::counted(sensors)),
      "give the places with --array FILE.toml ([array] positions_m = [[x, y, z], ...], in m), or keep "
      "them with the poses: mgt import POSES.csv --array FILE.toml -o RUN.mgtrun");
}

}  // namespace mgtd::daemon::cli
