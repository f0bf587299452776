// SPDX-License-Identifier: Apache-2.0
#include "tests/blind/law_kinds.h"

#include <utility>

#include "tests/blind/rig_kind.h"
#include "tests/rig/effects/temperature_law.h"

namespace mgtd::calib::testing {
namespace {

Planted gradient(Random& random) { return {"site.gradient", "all", direction(random, 5, 100)}; }
Planted curvature(Random& random) { return {"site.curvature", "all", direction(random, 7, 150)}; }

/// Two sources at the site.
RealKind pair(std::string name, std::string what, std::vector<std::string> right, Planted (*one)(Random&),
              Planted (*other)(Random&)) {
  return rig_kind(std::move(name), std::move(what), Must::name, std::move(right), false,
                  [one, other](Stage& stage, const PoseTable&, Random& random) {
                    plant(stage, one(random));
                    plant(stage, other(random));
                  });
}

/// One effect on one axis, its size given, its sign and place not.
RealKind law(std::string name, std::string what, const std::string& effect, double size) {
  return rig_kind(std::move(name), std::move(what), Must::name, {effect}, false,
                  [effect, size](Stage& stage, const PoseTable&, Random& random) {
                    const std::string where = axis_at_random(random);
                    plant(stage, {effect, where, {sign(random) * size}});
                  });
}

}  // namespace

std::vector<RealKind> law_kinds() {
  std::vector<RealKind> out{
      rig_kind("gradient-3000", "field gradient of 3000 nT/m", Must::name, {"site.gradient"}, false,
               [](Stage& stage, const PoseTable&, Random& random) {
                 plant(stage, {"site.gradient", "all", direction(random, 5, 3000)});
               }),
      rig_kind(
          "dipole", "a dipole of 3 A m2, 1 to 2 m away", Must::name, {"site.dipole"}, false,
          [](Stage& stage, const PoseTable&, Random& random) { plant(stage, dipole_at_random(random)); }),
      pair("two-dipoles", "two dipoles of 3 A m2, 1 to 2 m away", {"site.dipole"}, &dipole_at_random,
           &dipole_at_random),
      pair("dipole-gradient", "a dipole of 3 A m2, 1 to 2 m away, in a gradient of 100 nT/m",
           {"site.dipole", "site.gradient"}, &dipole_at_random, &gradient),
      pair("gradient-curvature", "a gradient of 100 nT/m and a curvature of 150 nT/m2",
           {"site.gradient", "site.curvature"}, &gradient, &curvature),
      law("gain-drift-209", "gain of one axis drifts, 209 ppm/h", "axis.gain.drift", 209),
      law("offset-drift-50", "offset of one axis drifts, 50 nT/h", "axis.offset.drift", 50),
      law("gain-temperature-300", "gain of one axis follows temperature, 300 ppm/degC",
          "axis.gain.temperature", 300),
      law("offset-temperature-2", "offset of one axis follows temperature, 2 nT/degC",
          "axis.offset.temperature", 2),
      rig_kind("two-laws", "offset with temperature (2 nT/degC) and a cubic term (8 nT)", Must::name,
               {"axis.offset.temperature", "axis.cubic"}, false,
               [](Stage& stage, const PoseTable&, Random& random) {
                 const std::string one = axis_at_random(random), other = axis_at_random(random);
                 plant(stage, {"axis.offset.temperature", one, {2 * sign(random)}});
                 plant(stage, {"axis.cubic", other, {8 * sign(random)}});
               }),
      rig_kind("motor", "a motor's current, recorded", Must::name, {"platform.current"}, false,
               [](Stage& stage, const PoseTable&, Random& random) {
                 const std::string where = sensor_at_random(random);
                 plant(stage, {"platform.current", where, direction(random, 3, 2), "motor_A"});
               }),
      rig_kind(
          "real-fluxgates", "temperature laws of four real fluxgates, 1/f of 20 pT/sqrt(Hz)", Must::open,
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

std::vector<RealKind> unlisted_kinds() {
  std::vector<RealKind> out{
      rig_kind("neighbour", "a neighbour's reading couples in", Must::pass, {}, false,
               [](Stage& stage, const PoseTable&, Random& random) {
                 const std::string where = sensor_at_random(random);
                 const auto nT = vector(random, 20);
                 plant(stage, {"hidden.neighbour", where, {nT[0], nT[1], nT[2], 1}});
               }),
      rig_kind("neighbour-squared", "the square of a neighbour's reading couples in, 5 nT", Must::open, {},
               false,
               [](Stage& stage, const PoseTable&, Random& random) {
                 const std::string where = sensor_at_random(random);
                 const auto nT = vector(random, 5);
                 plant(stage, {"hidden.neighbour", where, {nT[0], nT[1], nT[2], 2}});
               }),
      rig_kind("period-7", "a period of 7 poses on one axis, 1 nT", Must::open, {}, true,
               [](Stage& stage, const PoseTable&, Random& random) {
                 stage.scenario.visit.cycle_nT = 1;
                 stage.scenario.visit.cycle_where = *rig::Where::parse(axis_at_random(random));
               }),
      rig_kind("azimuth-3", "third harmonic of azimuth on one axis, 1 nT", Must::open, {}, false,
               [](Stage& stage, const PoseTable&, Random& random) {
                 const std::string where = axis_at_random(random);
                 plant(stage, {"hidden.azimuth-harmonic", where, {1, 3, between(random, 0, 360)}});
               }),
      rig_kind("motor-unrecorded", "a motor's current, not recorded", Must::open, {}, false,
               [](Stage& stage, const PoseTable&, Random& random) {
                 const std::string where = sensor_at_random(random);
                 for (auto& c : stage.scenario.covariates) c.recorded = c.recorded && c.name != "motor_A";
                 plant(stage, {"platform.current", where, direction(random, 3, 2), "motor_A"});
               }),
  };
  for (RealKind& kind : out)
    kind.tensor = !kind.name.starts_with("neighbour") && !kind.name.starts_with("motor");
  return out;
}

}  // namespace mgtd::calib::testing
