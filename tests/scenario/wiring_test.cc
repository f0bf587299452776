// SPDX-License-Identifier: Apache-2.0
// Sensors that sit or are wired otherwise than the rest are named in a run, and a magnet tells swapped
// cables, through the real drivers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/run/wiring_probe.h"
#include "tests/scenario/virtual_daemon.h"

namespace mgtd {
namespace {

using namespace mgtd::daemon;
using test::scenario_of;
using test::VirtualDaemon;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(WiringInARun, MirroredAndTurnedSensorsAreNamedAfterTheFirstTurns) {
  VirtualDaemon daemon(
      scenario_of("[rig]\nname = \"table6\"\nparameters = \"table6\"\nseed = 6\n"
                  "[s2]\nmounting = \"y -x z\"\n[s3]\nmounting = \"x -y z\"\n"));
  ASSERT_TRUE(daemon.run(60, [&] { return daemon.all_live(); }));
  daemon.start(*daemon::plan::make_plan(
      {.step_deg = 20, .random = 12, .revisits = 2, .dwell_short_s = 2, .dwell_long_s = 3},
      daemon.table().limits()));
  ASSERT_TRUE(daemon.run(600, [&] { return daemon.poses.poses.size() >= 5; })) << daemon.status->message;
  ASSERT_FALSE(daemon.finished) << daemon.finished->message;
  EXPECT_THAT(daemon.records,
              Contains(HasSubstr(
                  "wiring: s2: turned by 90 deg about z; s3: mirrored (left-handed axes: y reversed)")));
  EXPECT_THAT(daemon.status->checks, Contains(::testing::Field(&Check::name, "wiring")));
}

TEST(MagnetOnTheRig, SwappedCablesAreNamed) {
  VirtualDaemon daemon(scenario_of(
      "[rig]\nname = \"table6\"\nparameters = \"table6\"\nseed = 6\n[sensors]\nwiring = [3, 2, 1, 4]\n"));
  ASSERT_TRUE(daemon.run(60, [&] { return daemon.all_live(); }));
  daemon::run::WiringProbe magnet(daemon.now().mono);
  daemon.on_item = [&](const EpochOrGap& item) {
    if (const auto* epoch = std::get_if<Epoch>(&item)) magnet.add(*epoch);
    magnet.advance(daemon.now().mono);
  };
  const auto hands = [&] {  // a slow operator: a second behind what is asked for
    const MagnetStatus asked = magnet.status();
    daemon.run(1);
    daemon.rig.world().hold_magnet(asked.state == "waiting" ? *asked.arm : 0);
  };
  for (int i = 0; i < 100 && !magnet.ended(); ++i) hands();
  EXPECT_EQ(magnet.status().state, "done");
  EXPECT_THAT(findings(magnet.status()),
              ElementsAre("the cable labelled s3 is on arm 1", "the cable labelled s1 is on arm 3"));
}

}  // namespace
}  // namespace mgtd
