// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "calib/fit/joint/joint_fit.h"
#include "calib/sensor/geometry.h"
#include "proto/pose.h"
#include "tests/rig/effect_kind.h"
#include "tests/rig/simulated_table.h"

/// This plants effects of the simulated rig in runs without ports, as large as wanted in units of what the
/// run can tell. Two implementations meet here: the rig's physics knows nothing of calib.
namespace mgtd::calib::testing {

/// An effect of the rig. Its amplitudes are scaled; numbers inside the law (rig::Key: times, widths) stay.
struct Planted {
  std::string kind;               ///< as mgt-rig names it
  std::string where{"all"};       ///< all, s3 or s3.z
  std::vector<double> numbers{};  ///< key after key
  std::string of{};               ///< covariate
};

/// What a run on the rig is like when nothing is planted.
struct Stage {
  rig::Scenario scenario;
  rig::Design design;
};

/// 157 poses. Temperatures that go up and down about 20 degC while time goes on, a switched current
/// (motor_A), a battery that runs down (battery_V), each azimuth approached from either side.
[[nodiscard]] Stage full_stage(std::uint64_t seed);
/// A table with one axis: an array mounted in five ways, eighteen azimuths each.
[[nodiscard]] Stage remounted_stage(std::uint64_t seed);

/// One sensor: turned by a table in the field of the site, with a scalar reference.
[[nodiscard]] Stage one_turned_stage(std::uint64_t seed);
/// One sensor at rest in a coil cage: 120 fields from zero to full scale, known as vectors.
[[nodiscard]] Stage one_caged_stage(std::uint64_t seed);
/// Where the sensors of a stage stand.
[[nodiscard]] sensor::Geometry geometry_of(const Stage& stage);

/// As a scenario holds it. Throws where the rig knows no such effect.
[[nodiscard]] std::shared_ptr<const rig::Effect> make_planted(const Planted& effect);

/// The effect acts in every run of the stage.
void plant(Stage& stage, const Planted& effect);

[[nodiscard]] Planted scaled(Planted effect, double factor);
[[nodiscard]] PoseTable planted_run(const Stage& stage, const std::vector<Planted>& effects,
                                    std::uint64_t seed);

/// Length of what the effect does to the readings, in standard deviations, less everything that the
/// calibration and the unknowns of the poses can take of it: its size in Cramer-Rao sigmas.
[[nodiscard]] double sigmas_of(const Stage& stage, const Planted& effect, std::uint64_t seed);

/// The same of two runs that differ by one effect alone, as large as it is there.
[[nodiscard]] double sigmas_between(const PoseTable& without, const PoseTable& with,
                                    const fit::joint::JointOptions& options);

/// `effect` scaled to a size of `sigmas`; `factor`: by how much.
struct Sized {
  Planted effect;
  double factor{1};
};
[[nodiscard]] Sized sized(const Stage& stage, const Planted& effect, double sigmas, std::uint64_t seed);

}  // namespace mgtd::calib::testing
