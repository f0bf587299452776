// SPDX-License-Identifier: Apache-2.0
#include "tests/blind/planted.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "calib/criticism/tests/residual.h"
#include "calib/criticism/tests/rows.h"
#include "calib/effects/library/library.h"
#include "tests/rig/rotations.h"
#include "tests/rig/scenario.h"

namespace mgtd::calib::testing {
namespace {

const rig::EffectKind& kind_named(const std::string& name) {
  const auto kinds = rig::all_kinds();
  const auto found =
      std::find_if(kinds.begin(), kinds.end(), [&](const rig::EffectKind* k) { return k->name == name; });
  if (found == kinds.end()) throw std::runtime_error("the rig has no effect " + name);
  return **found;
}

rig::Scenario scenario() {
  rig::Scenario out;
  out.truth = *rig::rig_named("table6", 1);
  out.temperature = {.start_degC = 17.5,
                     .ramp_degC_per_h = 2,
                     .head_degC = {0.0, 0.5, -0.4, 0.3},
                     .pulse_degC = 7,
                     .pulse_at_s = 400,
                     .pulse_tau_s = 350};
  out.covariates = {
      {.name = "motor_A", .mean = 1, .amplitude = 1, .pattern = 7},
      {.name = "battery_V", .mean = 12.6, .amplitude = -0.9, .wave = rig::Wave::ramp, .every_s = 3600}};
  return out;
}

rig::Scenario one_sensor_scenario(std::uint64_t seed) {
  auto out = rig::parse_scenario("[rig]\nparameters = \"random\"\nseed = " + std::to_string(seed) +
                                     "\n[array]\npositions_m = [[0, 0, 0]]\n",
                                 "one-sensor.toml");
  if (!out) throw std::runtime_error(out.error().front());
  out->temperature = scenario().temperature;
  return *std::move(out);
}

/// By pose, what the effect adds to the readings and to the scalar reference, in standard deviations.
Eigen::MatrixXd signature(const fit::joint::JointFit& fit, const PoseTable& with, const PoseTable& without) {
  const auto n = static_cast<Eigen::Index>(fit.problem.poses.size());
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(n * fit.problem.pose_rows(), 1);
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto p = static_cast<std::size_t>(k);
    const fit::joint::JointPose& pose = fit.problem.poses[p];
    const int channels = fit.problem.channels();
    for (int c = 0; c < channels; ++c) {
      const auto s = static_cast<std::size_t>(c / 3);
      rows(k * fit.problem.pose_rows() + c, 0) =
          pose.weight[c] * (with.poses[p].y_nT[s] - without.poses[p].y_nT[s])[c % 3];
    }
    if (without.poses[p].f_nT)
      rows(k * fit.problem.pose_rows() + channels, 0) =
          (*with.poses[p].f_nT - *without.poses[p].f_nT) * pose.f_weight;
  }
  return rows;
}

}  // namespace

Stage full_stage(std::uint64_t seed) { return {scenario(), rig::run_of_157({.senses = true}, seed)}; }

Stage remounted_stage(std::uint64_t seed) {
  using rig::about_x, rig::about_y, rig::about_z;
  const std::vector<Eigen::Matrix3d> mounts{Eigen::Matrix3d::Identity(), about_x(90), about_y(90),
                                            about_x(35) * about_z(50), about_y(-40) * about_x(20)};
  return {scenario(), rig::remounted_turns(mounts, 18, seed)};
}

Stage one_turned_stage(std::uint64_t seed) {
  return {one_sensor_scenario(seed), rig::run_of_157({.senses = true}, seed)};
}

Stage one_caged_stage(std::uint64_t seed) {
  rig::Scenario s = one_sensor_scenario(seed);
  s.reference = rig::VectorReference{.sd_nT = 0.2, .misalignment_deg = {1, -2, 3}, .on_platform = true};
  s.cage = rig::Cage{.sphere = false, .max_nT = 60'000, .poses = 120};
  s.angles = s.scalar = false;
  rig::Design design = rig::cage_fields(*s.cage, seed);
  return {std::move(s), std::move(design)};
}

sensor::Geometry geometry_of(const Stage& stage) {
  const std::vector<Eigen::Vector3d> places_m = stage.scenario.places_m();
  PerSensor<Eigen::Vector3d> places_P_m(0);
  places_P_m.assign(places_m.begin(), places_m.end());
  return sensor::Geometry(places_P_m);
}

std::shared_ptr<const rig::Effect> make_planted(const Planted& effect) {
  return rig::make_effect(kind_named(effect.kind), rig::Where::parse(effect.where).value(),
                          {.value = effect.numbers}, effect.of);
}

void plant(Stage& stage, const Planted& effect) { stage.scenario.effects.push_back(make_planted(effect)); }

Planted scaled(Planted effect, double factor) {
  const rig::EffectKind& kind = kind_named(effect.kind);
  std::size_t next = 0;
  for (const rig::Key& key : kind.keys) {
    if (key.name == nullptr) break;
    const bool by_size = key.low == key.high && !(key.fallback > 0);  // zero or none
    for (int i = 0; i < key.count; ++i, ++next)
      if (by_size) effect.numbers.at(next) *= factor;
  }
  return effect;
}

PoseTable planted_run(const Stage& stage, const std::vector<Planted>& effects, std::uint64_t seed) {
  rig::Scenario scenario = stage.scenario;
  for (const Planted& effect : effects) scenario.effects.push_back(make_planted(effect));
  return rig::simulated_table(std::move(scenario), stage.design, seed);
}

double sigmas_of(const Stage& stage, const Planted& effect, std::uint64_t seed) {
  // So little of it that only what is linear is seen.
  constexpr double kLittle = 1e-3;
  // The same seed draws the same noise and the same errors of the table: what differs is the effect.
  const PoseTable without = planted_run(stage, {}, seed);
  const PoseTable with = planted_run(stage, {scaled(effect, kLittle)}, seed);
  fit::joint::JointOptions options;
  options.geometry = geometry_of(stage);
  if (!stage.scenario.scalar && !stage.scenario.reference) options.field_nT = stage.scenario.f_nT;
  return sigmas_between(without, with, options) / kLittle;
}

double sigmas_between(const PoseTable& without, const PoseTable& with,
                      const fit::joint::JointOptions& options) {
  const auto fit = fit::joint::fit_joint(without, options);
  if (!fit) throw std::runtime_error(fit.error().text());
  const criticism::tests::Residual residual(fit->problem, fit->state, 0);
  return residual.project(signature(*fit, with, without)).projected.norm();
}

Sized sized(const Stage& stage, const Planted& effect, double sigmas, std::uint64_t seed) {
  const double factor = sigmas / sigmas_of(stage, effect, seed);
  return {scaled(effect, factor), factor};
}

}  // namespace mgtd::calib::testing
