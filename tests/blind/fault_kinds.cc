// SPDX-License-Identifier: Apache-2.0
#include "tests/blind/fault_kinds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tests/blind/rig_kind.h"

namespace mgtd::calib::testing {
namespace {

using rig::Gross;

rig::GrossReading somewhere(Random& random, Gross what, const std::string& where, double nT = 0) {
  return {what, 10 + random() % 140, 1, *rig::Where::parse(where), nT};
}

RealKind off_by(double nT) {
  return rig_kind(fmt::format("gross-{:.0f}", nT),
                  fmt::format("one reading of one axis off by {:.0f} nT", nT), Must::pass, {}, true,
                  [nT](Stage& stage, const PoseTable&, Random& random) {
                    const std::string where = axis_at_random(random);
                    stage.scenario.gross = {somewhere(random, Gross::off, where, sign(random) * nT)};
                  });
}

/// A magnet that is dropped between pose `after` and the next.
Change dropped(const std::function<std::size_t(Random&)>& after) {
  return [after](Stage& stage, const PoseTable& plain, Random& random) {
    const std::size_t pose = after(random);
    const double at_s = (*plain.poses[pose - 1].t_s + *plain.poses[pose].t_s) / 2;
    stage.scenario.magnets = {
        {.at_s = at_s, .moment_Am2 = vector(random, 20), .at_m = vector(random, between(random, 2, 3.5))}};
  };
}

RealKind apart_no_angles(const Change& apart) {
  RealKind out = rig_kind("apart-no-angles", "the same without angles", Must::refuse, {}, false, apart);
  out.make = [with_angles = out.make](std::uint64_t seed) {
    RealRun run = with_angles(seed);
    for (Pose& pose : run.table.poses) pose.azimuth_rad = pose.pitch_rad = pose.roll_rad = std::nullopt;
    return run;
  };
  return out;
}

}  // namespace

std::vector<RealKind> wrong_reading_kinds() {
  std::vector<RealKind> out;
  for (const double nT : {5.0, 50.0, 200.0, 1000.0, 10'000.0}) out.push_back(off_by(nT));
  out.push_back(rig_kind("stuck", "one axis stuck for one pose", Must::pass, {}, true,
                         [](Stage& stage, const PoseTable&, Random& random) {
                           const std::string where = axis_at_random(random);
                           stage.scenario.gross = {somewhere(random, Gross::stuck, where)};
                         }));
  out.push_back(rig_kind("saturated", "three readings at the rail", Must::pass, {}, true,
                         [](Stage& stage, const PoseTable&, Random& random) {
                           for (int k = 0; k < 3; ++k) {
                             const std::string where = axis_at_random(random);
                             stage.scenario.gross.push_back(somewhere(random, Gross::saturated, where));
                           }
                         }));
  out.push_back(
      rig_kind("gross-many", "one reading in ten off by 5 to 1000 nT, so in 72 % of the poses", Must::refuse,
               {}, true, [](Stage& stage, const PoseTable&, Random& random) {
                 for (std::uint64_t pose = 1; pose <= 157; ++pose) {
                   for (int c = 0; c < 12; ++c) {
                     if (random() % 10 != 0) continue;
                     const double nT = 5 * std::pow(200, between(random, 0, 1)) * sign(random);
                     const std::string where = fmt::format("s{}.{}", c / 3 + 1, "xyz"[c % 3]);
                     stage.scenario.gross.push_back({Gross::off, pose, 1, *rig::Where::parse(where), nT});
                   }
                 }
               }));
  out.push_back(rig_kind("gross-sensor", "one sensor off by 300 nT for ten poses", Must::set_aside, {}, true,
                         [](Stage& stage, const PoseTable&, Random& random) {
                           auto gross = somewhere(random, Gross::off, sensor_at_random(random), 300);
                           gross.poses = 10;
                           gross.pose =
                               std::min<std::uint64_t>(gross.pose, 143);  // to the end it were a step
                           stage.scenario.gross = {gross};
                         }));
  return out;
}

std::vector<RealKind> disturbance_kinds() {
  return {
      rig_kind("car", "a car stands beside the array for five poses", Must::set_aside,
               {"site.transient", "site.dipole"}, true,
               [](Stage& stage, const PoseTable& plain, Random& random) {
                 const std::size_t first = 20 + random() % 110;
                 const double from_s = *plain.poses[first].t_s - 1, until_s = *plain.poses[first + 4].t_s + 1;
                 stage.scenario.vehicles = {
                     {.at_s = from_s, .nearest_m = between(random, 6, 10), .stands_s = until_s - from_s}};
               }),
      rig_kind("magnet", "a magnet is dropped 2 to 3.5 m away before pose 80 and stays", Must::name,
               {"site.step", "site.gradient-drift", "site.dipole"}, false,
               dropped([](Random&) { return std::size_t{79}; })),
      rig_kind("magnet-late", "the same before one of the poses 111 to 140", Must::name,
               {"site.step", "site.gradient-drift", "site.dipole"}, false,
               dropped([](Random& random) { return std::size_t{110 + random() % 30}; })),
      rig_kind("step-sensor", "the offsets of one sensor step by 1 to 20 nT, at any time", Must::name,
               {"axis.offset.step"}, false,
               [](Stage& stage, const PoseTable& plain, Random& random) {
                 const double at_s = between(random, *plain.poses[15].t_s, *plain.poses[141].t_s);
                 const double nT = std::pow(20, between(random, 0, 1)) * sign(random);
                 plant(stage, {"axis.offset.step", sensor_at_random(random), {nT, at_s}});
               }),
  };
}

std::vector<RealKind> mistake_kinds() {
  const Change apart = [](Stage& stage, const PoseTable&, Random&) { stage.scenario.apart = true; };
  return {
      rig_kind("mirrored", "one sensor is mirrored", Must::agree, {}, true,
               [](Stage& stage, const PoseTable&, Random& random) {
                 rig::SensorTruth& sensor = stage.scenario.truth.at(random() % 4);
                 sensor.mounting.col(static_cast<Eigen::Index>(random() % 3)) *= -1;
               }),
      rig_kind("apart", "four sensors that did not share attitudes, with the angles of the first",
               Must::refuse, {}, false, apart),
      apart_no_angles(apart),
      rig_kind(
          "copied", "one sensor copied four times", Must::refuse, {}, false,
          [](Stage& stage, const PoseTable&, Random& random) { stage.scenario.copied = 1 + random() % 4; }),
  };
}

}  // namespace mgtd::calib::testing
