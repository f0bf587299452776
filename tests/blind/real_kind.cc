// SPDX-License-Identifier: Apache-2.0
#include "tests/blind/real_kind.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "tests/blind/planted.h"
#include "tests/blind/real_draw.h"
#include "tests/rig/effects/temperature_law.h"

namespace mgtd::calib::testing {
namespace {

using rig::Gross;
using rig::Scenario;

/// Changes what the plain rig is; `plain` is its run, for the times of the poses.
using Change = std::function<void(Stage&, const PoseTable& plain, Random&)>;
/// Where the poses of both are.
using Poses = rig::Design (*)(const Scenario&, std::uint64_t seed);

rig::Design usual(const Scenario&, std::uint64_t seed) { return rig::run_of_157({.senses = true}, seed); }
rig::Design none_again(const Scenario&, std::uint64_t seed) {
  return rig::run_of_157({.revisits = 0, .senses = true}, seed);
}
rig::Design one_octant(const Scenario& s, std::uint64_t seed) {
  return rig::run_of_157({.standard = false, .random = 157, .senses = true, .octant = s.field_direction()},
                         seed);
}

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

RealKind kind(std::string name, std::string what, Must must, std::vector<std::string> right, bool parameters,
              const Change& change, Poses poses = &usual) {
  return {std::move(name), std::move(what), must, std::move(right), parameters, [=](std::uint64_t seed) {
            return run_of(poses, change, parameters, seed);
          }};
}

/// Only the noise is another.
RealKind noise(std::string name, std::string what, void (*change)(Scenario&), Poses poses = &usual) {
  return kind(
      std::move(name), std::move(what), Must::pass, {}, true,
      [change](Stage& stage, const PoseTable&, Random&) { change(stage.scenario); }, poses);
}

void plant(Scenario& scenario, const Planted& effect) { scenario.effects.push_back(make_planted(effect)); }

std::vector<RealKind> noises() {
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
      kind("walk-one-sensor", "offsets of one sensor walk, 1 nT/sqrt(h)", Must::pass, {}, true,
           [](Stage& stage, const PoseTable&, Random& random) {
             plant(stage.scenario, {"hidden.offset-walk", sensor_at_random(random), {1}});
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

std::vector<RealKind> designs() {
  return {
      noise(
          "octant", "poses in one octant only", [](Scenario&) {}, &one_octant),
      noise("hand-table", "table set by hand, 2 degrees", [](Scenario& s) { s.table_accuracy_deg = 2; }),
      kind(
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

rig::GrossReading somewhere(Random& random, Gross what, const std::string& where, double nT = 0) {
  return {what, 10 + random() % 140, 1, *rig::Where::parse(where), nT};
}

RealKind off_by(double nT) {
  return kind(fmt::format("gross-{:.0f}", nT), fmt::format("one reading of one axis off by {:.0f} nT", nT),
              Must::pass, {}, true, [nT](Stage& stage, const PoseTable&, Random& random) {
                const std::string where = axis_at_random(random);
                stage.scenario.gross = {somewhere(random, Gross::off, where, sign(random) * nT)};
              });
}

std::vector<RealKind> wrong_readings() {
  std::vector<RealKind> out;
  for (const double nT : {5.0, 50.0, 200.0, 1000.0, 10'000.0}) out.push_back(off_by(nT));
  out.push_back(kind("stuck", "one axis stuck for one pose", Must::pass, {}, true,
                     [](Stage& stage, const PoseTable&, Random& random) {
                       const std::string where = axis_at_random(random);
                       stage.scenario.gross = {somewhere(random, Gross::stuck, where)};
                     }));
  out.push_back(kind("saturated", "three readings at the rail", Must::pass, {}, true,
                     [](Stage& stage, const PoseTable&, Random& random) {
                       for (int k = 0; k < 3; ++k) {
                         const std::string where = axis_at_random(random);
                         stage.scenario.gross.push_back(somewhere(random, Gross::saturated, where));
                       }
                     }));
  out.push_back(
      kind("gross-many", "one reading in ten off by 5 to 1000 nT, so in 72 % of the poses", Must::refuse, {},
           true, [](Stage& stage, const PoseTable&, Random& random) {
             for (std::uint64_t pose = 1; pose <= 157; ++pose) {
               for (int c = 0; c < 12; ++c) {
                 if (random() % 10 != 0) continue;
                 const double nT = 5 * std::pow(200, between(random, 0, 1)) * sign(random);
                 const std::string where = fmt::format("s{}.{}", c / 3 + 1, "xyz"[c % 3]);
                 stage.scenario.gross.push_back({Gross::off, pose, 1, *rig::Where::parse(where), nT});
               }
             }
           }));
  out.push_back(kind("gross-sensor", "one sensor off by 300 nT for ten poses", Must::set_aside, {}, true,
                     [](Stage& stage, const PoseTable&, Random& random) {
                       auto gross = somewhere(random, Gross::off, sensor_at_random(random), 300);
                       gross.poses = 10;
                       stage.scenario.gross = {gross};
                     }));
  return out;
}

std::vector<RealKind> disturbances() {
  return {
      kind("car", "a car stands beside the array for five poses", Must::set_aside,
           {"site.transient", "site.dipole"}, true,
           [](Stage& stage, const PoseTable& plain, Random& random) {
             const std::size_t first = 20 + random() % 110;
             const double from_s = *plain.poses[first].t_s - 1, until_s = *plain.poses[first + 4].t_s + 1;
             stage.scenario.vehicles = {
                 {.at_s = from_s, .nearest_m = between(random, 6, 10), .stands_s = until_s - from_s}};
           }),
      kind("magnet", "a magnet is dropped 2 to 3.5 m away before pose 80 and stays", Must::name,
           {"site.step", "site.gradient-drift", "site.dipole"}, false,
           [](Stage& stage, const PoseTable& plain, Random& random) {
             const double at_s = (*plain.poses[78].t_s + *plain.poses[79].t_s) / 2;
             stage.scenario.magnets = {{.at_s = at_s,
                                        .moment_Am2 = vector(random, 20),
                                        .at_m = vector(random, between(random, 2, 3.5))}};
           }),
  };
}

Planted dipole(Random& random) {
  const auto moment = vector(random, 3), at = vector(random, between(random, 1, 2));
  return {"site.dipole", "all", {moment[0], moment[1], moment[2], at[0], at[1], at[2]}};
}

Planted gradient(Random& random) { return {"site.gradient", "all", direction(random, 5, 100)}; }
Planted curvature(Random& random) { return {"site.curvature", "all", direction(random, 7, 150)}; }

/// Two sources at the site.
RealKind pair(std::string name, std::string what, std::vector<std::string> right, Planted (*one)(Random&),
              Planted (*other)(Random&)) {
  return kind(std::move(name), std::move(what), Must::name, std::move(right), false,
              [one, other](Stage& stage, const PoseTable&, Random& random) {
                plant(stage.scenario, one(random));
                plant(stage.scenario, other(random));
              });
}

/// One effect on one axis, its size given, its sign and place not.
RealKind law(std::string name, std::string what, const std::string& effect, double size) {
  return kind(std::move(name), std::move(what), Must::name, {effect}, false,
              [effect, size](Stage& stage, const PoseTable&, Random& random) {
                const std::string where = axis_at_random(random);
                plant(stage.scenario, {effect, where, {sign(random) * size}});
              });
}

std::vector<RealKind> laws() {
  std::vector<RealKind> out{
      kind("gradient-3000", "field gradient of 3000 nT/m", Must::name, {"site.gradient"}, false,
           [](Stage& stage, const PoseTable&, Random& random) {
             plant(stage.scenario, {"site.gradient", "all", direction(random, 5, 3000)});
           }),
      kind("dipole", "a dipole of 3 A m2, 1 to 2 m away", Must::name, {"site.dipole"}, false,
           [](Stage& stage, const PoseTable&, Random& random) { plant(stage.scenario, dipole(random)); }),
      pair("two-dipoles", "two dipoles of 3 A m2, 1 to 2 m away", {"site.dipole"}, &dipole, &dipole),
      pair("dipole-gradient", "a dipole of 3 A m2, 1 to 2 m away, in a gradient of 100 nT/m",
           {"site.dipole", "site.gradient"}, &dipole, &gradient),
      pair("gradient-curvature", "a gradient of 100 nT/m and a curvature of 150 nT/m2",
           {"site.gradient", "site.curvature"}, &gradient, &curvature),
      law("gain-drift-209", "gain of one axis drifts, 209 ppm/h", "axis.gain.drift", 209),
      law("offset-drift-50", "offset of one axis drifts, 50 nT/h", "axis.offset.drift", 50),
      law("gain-temperature-300", "gain of one axis follows temperature, 300 ppm/degC",
          "axis.gain.temperature", 300),
      law("offset-temperature-2", "offset of one axis follows temperature, 2 nT/degC",
          "axis.offset.temperature", 2),
      kind("two-laws", "offset with temperature (2 nT/degC) and a cubic term (8 nT)", Must::name,
           {"axis.offset.temperature", "axis.cubic"}, false,
           [](Stage& stage, const PoseTable&, Random& random) {
             const std::string one = axis_at_random(random), other = axis_at_random(random);
             plant(stage.scenario, {"axis.offset.temperature", one, {2 * sign(random)}});
             plant(stage.scenario, {"axis.cubic", other, {8 * sign(random)}});
           }),
      kind("motor", "a motor's current, recorded", Must::name, {"platform.current"}, false,
           [](Stage& stage, const PoseTable&, Random& random) {
             const std::string where = sensor_at_random(random);
             plant(stage.scenario, {"platform.current", where, direction(random, 3, 2), "motor_A"});
           }),
      kind("real-fluxgates", "temperature laws of four real fluxgates, 1/f of 20 pT/sqrt(Hz)", Must::open,
           {"axis.offset.temperature", "axis.offset.temperature2", "axis.gain.temperature",
            "axis.gain.temperature2", "axis.orthogonality.temperature", "axis.orthogonality.temperature2"},
           false,
           [](Stage& stage, const PoseTable&, Random&) {
             stage.scenario.effects.push_back(std::make_shared<rig::TemperatureLaw>());
             stage.scenario.noise.flicker_nT_per_sqrt_hz = 0.02;
           }),
  };
  for (RealKind& kind : out) kind.tensor = kind.name != "motor";
  return out;
}

std::vector<RealKind> in_no_library() {
  std::vector<RealKind> out{
      kind("neighbour", "a neighbour's reading couples in", Must::pass, {}, false,
           [](Stage& stage, const PoseTable&, Random& random) {
             const std::string where = sensor_at_random(random);
             const auto nT = vector(random, 20);
             plant(stage.scenario, {"hidden.neighbour", where, {nT[0], nT[1], nT[2], 1}});
           }),
      kind("neighbour-squared", "the square of a neighbour's reading couples in, 5 nT", Must::open, {}, false,
           [](Stage& stage, const PoseTable&, Random& random) {
             const std::string where = sensor_at_random(random);
             const auto nT = vector(random, 5);
             plant(stage.scenario, {"hidden.neighbour", where, {nT[0], nT[1], nT[2], 2}});
           }),
      kind("period-7", "a period of 7 poses on one axis, 1 nT", Must::open, {}, true,
           [](Stage& stage, const PoseTable&, Random& random) {
             stage.scenario.visit.cycle_nT = 1;
             stage.scenario.visit.cycle_where = *rig::Where::parse(axis_at_random(random));
           }),
      kind("azimuth-3", "third harmonic of azimuth on one axis, 1 nT", Must::open, {}, false,
           [](Stage& stage, const PoseTable&, Random& random) {
             const std::string where = axis_at_random(random);
             plant(stage.scenario, {"hidden.azimuth-harmonic", where, {1, 3, between(random, 0, 360)}});
           }),
      kind("motor-unrecorded", "a motor's current, not recorded", Must::open, {}, false,
           [](Stage& stage, const PoseTable&, Random& random) {
             const std::string where = sensor_at_random(random);
             for (auto& c : stage.scenario.covariates) c.recorded = c.recorded && c.name != "motor_A";
             plant(stage.scenario, {"platform.current", where, direction(random, 3, 2), "motor_A"});
           }),
  };
  for (RealKind& kind : out)
    kind.tensor = !kind.name.starts_with("neighbour") && !kind.name.starts_with("motor");
  return out;
}

std::vector<RealKind> mistakes() {
  const auto without_angles = [](RealRun run) {
    for (Pose& pose : run.table.poses) pose.azimuth_rad = pose.pitch_rad = pose.roll_rad = std::nullopt;
    return run;
  };
  const Change apart = [](Stage& stage, const PoseTable&, Random&) { stage.scenario.apart = true; };
  return {
      kind("mirrored", "one sensor is mirrored", Must::agree, {}, true,
           [](Stage& stage, const PoseTable&, Random& random) {
             rig::SensorTruth& sensor = stage.scenario.truth.at(random() % 4);
             sensor.mounting.col(static_cast<Eigen::Index>(random() % 3)) *= -1;
           }),
      kind("apart", "four sensors that did not share attitudes, with the angles of the first", Must::refuse,
           {}, false, apart),
      {"apart-no-angles",
       "the same without angles",
       Must::refuse,
       {},
       false,
       [=](std::uint64_t seed) { return without_angles(run_of(&usual, apart, false, seed)); }},
      kind("copied", "one sensor copied four times", Must::refuse, {}, false,
           [](Stage& stage, const PoseTable&, Random& random) { stage.scenario.copied = 1 + random() % 4; }),
  };
}

/// An effect as large as `d` of its own uncertainties; `effect` draws its shape.
RealKind of_site(const std::string& name, std::vector<std::string> right, double d,
                 Planted (*effect)(Random&)) {
  RealKind out{.name = fmt::format("{}-d{:.0f}", name, d),
               .what = name,
               .must = Must::name,
               .right = std::move(right),
               .parameters = false,
               .d = d};
  out.make = [=](std::uint64_t seed) {
    const Stage stage = full_stage(seed);
    Random random(seed ^ 0x2545f4914f6cdd1dU);
    const Planted planted = sized(stage, effect(random), d, seed).effect;
    return RealRun{planted_run(stage, {planted}, seed), planted_run(stage, {}, seed), stage.scenario.truth,
                   stage.scenario.truth};
  };
  return out;
}

}  // namespace

const std::vector<RealKind>& real_kinds() {
  static const std::vector<RealKind> all = [] {
    std::vector<RealKind> out;
    for (auto&& part :
         {noises(), designs(), wrong_readings(), disturbances(), laws(), in_no_library(), mistakes()})
      out.insert(out.end(), part.begin(), part.end());
    return out;
  }();
  return all;
}

const std::vector<RealKind>& site_kinds() {
  static const std::vector<RealKind> all = [] {
    std::vector<RealKind> out;
    for (const double d : {8.0, 15.0, 40.0}) {
      out.push_back(of_site("gradient", {"site.gradient"}, d, [](Random& random) -> Planted {
        return {"site.gradient", "all", direction(random, 5, 1)};
      }));
      out.push_back(of_site("curvature", {"site.curvature"}, d, [](Random& random) -> Planted {
        return {"site.curvature", "all", direction(random, 7, 1)};
      }));
      out.push_back(of_site("dipole", {"site.dipole"}, d, &dipole));
      out.push_back(of_site("step", {"site.step", "site.gradient-drift"}, d, [](Random& random) -> Planted {
        std::vector<double> numbers = direction(random, 5, 1);
        numbers.push_back(between(random, 400, 1400));
        return {"site.gradient-step", "all", numbers};
      }));
      out.push_back(of_site("transient", {"site.transient", "site.dipole"}, d, [](Random& random) -> Planted {
        const auto moment = vector(random, 60), nearest = vector(random, between(random, 2, 3));
        return {"hidden.passing-iron",
                "all",
                {moment[0], moment[1], moment[2], nearest[0], nearest[1], nearest[2], 0.03,
                 between(random, 400, 1400)}};
      }));
    }
    return out;
  }();
  return all;
}

}  // namespace mgtd::calib::testing
