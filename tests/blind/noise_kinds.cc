// SPDX-License-Identifier: Apache-2.0
#include "tests/blind/noise_kinds.h"

#include <utility>

#include "tests/blind/rig_kind.h"

namespace mgtd::calib::testing {
namespace {

using rig::Scenario;

rig::Design none_again(const Scenario&, std::uint64_t seed) {
  return rig::run_of_157({.revisits = 0, .senses = true}, seed);
}
rig::Design one_octant(const Scenario& s, std::uint64_t seed) {
  return rig::run_of_157({.standard = false, .random = 157, .senses = true, .octant = s.field_direction()},
                         seed);
}

/// Only the noise is another.
RealKind noise(std::string name, std::string what, void (*change)(Scenario&), Poses poses = &usual_poses) {
  return rig_kind(
      std::move(name), std::move(what), Must::pass, {}, true,
      [change](Stage& stage, const PoseTable&, Random&) { change(stage.scenario); }, poses);
}

}  // namespace

std::vector<RealKind> noise_kinds() {
  return {
      noise("white", "white", [](Scenario&) {}),
      noise("ar-0.5-told", "correlated 0.5 from sample to sample, `n_eff` told",
            [](Scenario& s) { s.noise.ar1_rho = 0.5; }),
      noise("ar-0.9-told", "correlated 0.9, `n_eff` told", [](Scenario& s) { s.noise.ar1_rho = 0.9; }),
      noise("ar-0.5", "correlated 0.5, not told",
            [](Scenario& s) { s.noise.ar1_rho = 0.5, s.noise.tells_n_eff = false; }),
      noise("ar-0.9", "correlated 0.9, not told",
            [](Scenario& s) { s.noise.ar1_rho = 0.9, s.noise.tells_n_eff = false; }),
      noise(
          "ar-0.5-once", "correlated 0.5, not told, no pose visited again",
          [](Scenario& s) { s.noise.ar1_rho = 0.5, s.noise.tells_n_eff = false; }, &none_again),
      noise(
          "ar-0.9-once", "correlated 0.9, not told, no pose visited again",
          [](Scenario& s) { s.noise.ar1_rho = 0.9, s.noise.tells_n_eff = false; }, &none_again),
      noise("visit", "0.05 nT that a revisit does not reproduce",
            [](Scenario& s) { s.visit.noise_nT = 0.05; }),
      noise("visit-student", "the same with heavy tails (Student t, 3 degrees of freedom)",
            [](Scenario& s) { s.visit = {.kind = rig::NoiseKind::student, .noise_nT = 0.05}; }),
      noise("walk-0.3", "offsets walk at random, 0.3 nT/sqrt(h)",
            [](Scenario& s) { s.noise.walk_nT_per_sqrt_h = 0.3; }),
      noise("walk-1", "offsets walk at random, 1 nT/sqrt(h)",
            [](Scenario& s) { s.noise.walk_nT_per_sqrt_h = 1; }),
      noise(
          "walk-1-once", "the same, no pose visited again",
          [](Scenario& s) { s.noise.walk_nT_per_sqrt_h = 1; }, &none_again),
      rig_kind("walk-one-sensor", "offsets of one sensor walk, 1 nT/sqrt(h)", Must::pass, {}, true,
               [](Stage& stage, const PoseTable&, Random& random) {
                 plant(stage, {"hidden.offset-walk", sensor_at_random(random), {1}});
               }),
      noise("flicker-6pT", "1/f, 6 pT/sqrt(Hz) at 1 Hz: a low-noise fluxgate",
            [](Scenario& s) { s.noise.flicker_nT_per_sqrt_hz = 0.006; }),
      noise("flicker-20pT", "1/f, 20 pT/sqrt(Hz) at 1 Hz: a basic fluxgate",
            [](Scenario& s) { s.noise.flicker_nT_per_sqrt_hz = 0.02; }),
      noise("quantised-0.1", "means in steps of 0.1 nT", [](Scenario& s) { s.noise.mean_step_nT = 0.1; }),
      noise("quantised-1", "means in steps of 1 nT", [](Scenario& s) { s.noise.mean_step_nT = 1; }),
      noise(
          "quantised-0.1-once", "steps of 0.1 nT, no pose visited again",
          [](Scenario& s) { s.noise.mean_step_nT = 0.1; }, &none_again),
      noise(
          "quantised-1-once", "steps of 1 nT, no pose visited again",
          [](Scenario& s) { s.noise.mean_step_nT = 1; }, &none_again),
      noise("samples-1", "samples in steps of 1 nT, 0.3 nT of noise on them",
            [](Scenario& s) { s.noise.lsb_nT = 1; }),
  };
}

std::vector<RealKind> design_kinds() {
  return {
      noise(
          "octant", "poses in one octant only", [](Scenario&) {}, &one_octant),
      noise("hand-table", "table set by hand, 2 degrees", [](Scenario& s) { s.table_accuracy_deg = 2; }),
      rig_kind(
          "all-of-it", "correlated 0.9 (not told), walk 1 nT/sqrt(h), steps of 0.1 nT, one octant, 2 degrees",
          Must::no_name, {}, true,
          [](Stage& stage, const PoseTable&, Random&) {
            Scenario& s = stage.scenario;
            s.noise.ar1_rho = 0.9;
            s.noise.tells_n_eff = false;
            s.noise.walk_nT_per_sqrt_h = 1;
            s.noise.mean_step_nT = 0.1;
            s.table_accuracy_deg = 2;
          },
          &one_octant),
  };
}

}  // namespace mgtd::calib::testing
