// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/table_file.h"

#include <fmt/format.h>

#include <cstdio>
#include <optional>
#include <utility>

#include "tests/rig/pose_writer.h"
#include "tests/rig/recording.h"
#include "tests/rig/simulated_table.h"
#include "tests/rig/text_file.h"

namespace mgtd::rig {
namespace {

DesignOptions options_of(const std::string& poses, const Scenario& s) {
  DesignOptions out{.tilt_limit_deg = s.tilt_limit_deg};
  if (poses == "octant157") {
    out.standard = false;
    out.random = 157;
    out.octant = s.field_direction();
  }
  return out;
}

/// The design that is meant by name, or by the file of a list. Nothing with the reason on stderr.
std::optional<Design> design_of(const std::string& poses, const Scenario& s) {
  if (poses == "grid5832") return grid_of_5832();
  if (poses == "run157" || poses == "octant157") return run_of_157(options_of(poses, s), s.seed);
  const auto csv = text_of_file(poses);
  if (!csv) return std::nullopt;
  ListedDesign listed = listed_design(*csv);
  if (listed.error.empty()) return std::move(listed.design);
  fmt::print(stderr, "mgt-rig: {}: {}\n", poses, listed.error);
  return std::nullopt;
}

int write_survey(const TableFileOptions& options, Scenario s, const Design& design) {
  const std::uint64_t seed = s.seed;
  const Sampling sampling = options.samples ? Sampling::samples : Sampling::means;
  return write_file(options.output, pose_table_csv(simulated_survey(std::move(s), design, seed, sampling)));
}

int write_own_rows(const TableFileOptions& options, Scenario s) {
  if (options.poses_given) {
    fmt::print(stderr, "mgt-rig: {} says itself which rows there are; leave --poses out\n",
               s.recording ? "[recording]" : "[cage]");
    return 2;
  }
  if (s.recording) return write_file(options.output, pose_table_csv(simulated_recording(std::move(s))));
  const Design design = cage_fields(*s.cage, s.seed);
  return write_survey(options, std::move(s), design);
}

}  // namespace

int write_table_file(const TableFileOptions& options, Scenario s) {
  if (s.recording || s.cage) return write_own_rows(options, std::move(s));
  if (options.poses == "octant157" && s.tilt_limit_deg < 90) {
    fmt::print(stderr, "mgt-rig: octant157 tilts the array by up to 90 degrees; tilt_limit_deg = {}\n",
               s.tilt_limit_deg);
    return 2;
  }
  if (options.poses == "grid5832") s.table_accuracy_deg = 0;
  auto design = design_of(options.poses, s);
  if (!design) return 2;
  design->begin_s = options.begin_s;
  return write_survey(options, std::move(s), *design);
}

}  // namespace mgtd::rig
