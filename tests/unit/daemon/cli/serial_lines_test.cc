// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/serial_lines.h"

#include <gmock/gmock.h>

namespace mgtd::daemon::cli {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr const char* kConfig =
    "# a rig\n"
    "[[sensor]]\nport = \"usb:A\"\nserial = \"\"   # filled in later\n"
    "[[sensor]]\nport = \"usb:B\"   # the arm to the west\n"
    "[[sensor]]\nport = \"usb:C\"\nserial = \"7\"\n"
    "[table]\ndriver = \"hand\"\n"
    "[scalar]\n  port = \"usb:D\"\n";

TEST(SerialLines, FillsInWhatIsNotStatedAndLeavesTheRest) {
  const SerialLines done = with_serials(
      kConfig, {{"s1", "1001"}, {"s2", "1002"}, {"s3", "1003"}, {"table", "9"}, {"scalar", "3"}});
  EXPECT_EQ(done.text,
            "# a rig\n"
            "[[sensor]]\nport = \"usb:A\"\nserial = \"1001\"   # filled in later\n"
            "[[sensor]]\nport = \"usb:B\"   # the arm to the west\nserial = \"1002\"\n"
            "[[sensor]]\nport = \"usb:C\"\nserial = \"7\"\n"
            "[table]\ndriver = \"hand\"\n"
            "[scalar]\n  port = \"usb:D\"\nserial = \"3\"\n");
  EXPECT_THAT(done.written, ElementsAre("s1", "s2", "scalar"));
  EXPECT_THAT(done.stated, ElementsAre("s3"));
}

TEST(SerialLines, NothingKnownChangesNothing) {
  const SerialLines done = with_serials(kConfig, {});
  EXPECT_EQ(done.text, kConfig);
  EXPECT_THAT(done.written, IsEmpty());
}

TEST(SerialLines, ComesFromWhatEachDriverIsTold) {
  EXPECT_EQ(stated_serial("obsdaq", "<obsDAQ V5.5.7>, serial 1002"), "1002");
  EXPECT_EQ(stated_serial("obsdaq", "<obsDAQ V5.5.7>"), "");
  EXPECT_EQ(stated_serial("gcs2", "PI, C-863, 0115500620, 1.2.5"), "0115500620");
  EXPECT_EQ(stated_serial("gsm", "Gem Systems GSM-19W 3101329 v6.0"), "3101329");
}

}  // namespace
}  // namespace mgtd::daemon::cli
