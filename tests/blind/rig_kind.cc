// SPDX-License-Identifier: Apache-2.0
#include "tests/blind/rig_kind.h"

#include <utility>

namespace mgtd::calib::testing {
namespace {

/// Offsets as they are in the last dwell, from which on a calibration is used: the same run once more with
/// next to no white noise, less the one in which nothing wanders either.
void let_offsets_wander(const Stage& stage, std::uint64_t seed, rig::RigTruth& truth) {
  Stage wandering = stage, still = stage;
  rig::SampleNoise& noise = wandering.scenario.noise;
  if (noise.walk_nT_per_sqrt_h == 0 && noise.flicker_nT_per_sqrt_hz == 0 && stage.scenario.effects.empty())
    return;
  noise.noise_nT = 1e-9;  // not none, which would draw other numbers
  noise.mean_step_nT = noise.lsb_nT = 0;
  still.scenario.noise = noise;
  still.scenario.noise.walk_nT_per_sqrt_h = still.scenario.noise.flicker_nT_per_sqrt_hz = 0;
  still.scenario.effects.clear();
  const auto last = [&](const Stage& one) { return planted_run(one, {}, seed).poses.back().y_nT; };
  const auto with = last(wandering), without = last(still);
  for (std::size_t i = 0; i < truth.size(); ++i) truth.at(i).offset_nT += with[i] - without[i];
}

RealRun run_of(Poses poses, const Change& change, bool parameters, std::uint64_t seed) {
  Stage stage = full_stage(seed);
  stage.design = poses(stage.scenario, seed);
  RealRun out{.plain = planted_run(stage, {}, seed), .plain_truth = stage.scenario.truth};
  Random random(seed ^ 0x2545f4914f6cdd1dU);
  change(stage, out.plain, random);
  out.truth = stage.scenario.truth;
  if (parameters) let_offsets_wander(stage, seed, out.truth);
  out.table = planted_run(stage, {}, seed);
  return out;
}

}  // namespace

rig::Design usual_poses(const rig::Scenario&, std::uint64_t seed) {
  return rig::run_of_157({.senses = true}, seed);
}

RealKind rig_kind(std::string name, std::string what, Must must, std::vector<std::string> right,
                  bool parameters, const Change& change, Poses poses) {
  return {std::move(name), std::move(what), must, std::move(right), parameters, [=](std::uint64_t seed) {
            return run_of(poses, change, parameters, seed);
          }};
}

}  // namespace mgtd::calib::testing
