// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/disturbance_section.h"

#include <fmt/format.h>

namespace mgtd::rig {

Vehicle read_vehicle(Section& section) {
  Vehicle v;
  section.read("at_s", v.at_s, {0, 1e9});
  section.read("nearest_m", v.nearest_m, {2, 1e4});
  section.read("speed_m_per_s", v.speed_m_per_s, {0.1, 100});
  section.read("stands_s", v.stands_s, {0, 1e9});
  section.read("moment_Am2", v.moment_Am2, {-1e6, 1e6});
  return v;
}

DroppedMagnet read_magnet(Section& section, double reach_m) {
  DroppedMagnet m;
  section.read("at_s", m.at_s, {0, 1e9});
  section.read("until_s", m.until_s, {0, 1e9});
  section.read("moment_Am2", m.moment_Am2);
  section.read("at_m", m.at_m);
  const double away_m = Eigen::Vector3d(m.at_m.data()).norm();
  if (away_m < reach_m)
    section.complain("at_m", fmt::format("at_m is {} m from the centre of the array and must be {} m or "
                                         "more, so that the magnet lies outside of it",
                                         away_m, reach_m));
  return m;
}

GrossReading read_gross(Section& section) {
  GrossReading g;
  std::string what = "off";
  section.read("do", what);
  section.read("pose", g.pose);
  section.read("poses", g.poses);
  section.read("nT", g.nT, {-1e6, 1e6});
  g.where = section.where();
  if (g.pose == 0) section.complain("pose", "poses are counted from 1");
  if (what == "stuck") {
    g.kind = Gross::stuck;
  } else if (what == "saturated") {
    g.kind = Gross::saturated;
  } else if (what != "off") {
    section.complain("do", fmt::format("do = '{}' must be off, stuck or saturated", what));
  }
  return g;
}

}  // namespace mgtd::rig
