// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/array_places.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <string>

#include "daemon/config/config.h"

namespace mgtd::daemon::config {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

std::string error_of(const std::string& text) {
  const auto geometry = array_from_text(text, "array.toml");
  if (geometry) return "it was read";
  EXPECT_THAT(geometry.error().remedy, HasSubstr("positions_m"));
  return geometry.error().message;
}

TEST(ArrayPlaces, AreReadInTheirOrder) {
  const auto geometry = array_from_text(
      "[array]\npositions_m = [[0.2, 0, -1], [0, 0.1, 0]]\n[rig]\nname = \"x\"\n", "array.toml");
  ASSERT_TRUE(geometry) << geometry.error().text();
  ASSERT_EQ(geometry->sensors(), 2U);
  EXPECT_EQ(geometry->positions_P_m()[0], Eigen::Vector3d(0.2, 0, -1));
  EXPECT_EQ(geometry->positions_P_m()[1], Eigen::Vector3d(0, 0.1, 0));
}

TEST(ArrayPlaces, MistakesAreNamedWithLineAndColumn) {
  EXPECT_THAT(error_of("[array\n"), StartsWith("array.toml:1:"));
  EXPECT_THAT(error_of("[rig]\nname = \"x\"\n"), StartsWith("array.toml:1:1: there is no section [array]"));
  EXPECT_THAT(error_of("[rig]\nbaseline_m = 0.4\n[array]\npositions_m = [[0, 0, 0]]\n"),
              StartsWith("array.toml:3:1: [array]: baseline_m in [rig]"));
  EXPECT_THAT(error_of("array = 3\n"), StartsWith("array.toml:1:9: 'array' must be a section"));
  EXPECT_THAT(error_of("\n[array]\n"), StartsWith("array.toml:2:1: [array]: positions_m is missing"));
  EXPECT_THAT(error_of("[array]\nplaces_m = [[0, 0, 0]]\npositions_m = [[0, 0, 0]]\n"),
              StartsWith("array.toml:2:1: [array]: unknown key 'places_m'"));
  EXPECT_THAT(error_of("[array]\npositions_m = 0.4\n"),
              StartsWith("array.toml:2:15: [array]: positions_m must be"));
  EXPECT_THAT(error_of("[array]\npositions_m = []\n"), HasSubstr("holds 0 places; an array has 1 to 16"));
  EXPECT_THAT(error_of("[array]\npositions_m = [[0, 0, 0], [0, 1]]\n"),
              StartsWith("array.toml:2:27: [array]: the place of s2 must be [x, y, z]"));
  for (const char* bad : {"nan", "inf", "\"0\"", "true", "101"})
    EXPECT_THAT(error_of(fmt::format("[array]\npositions_m = [[0, {}, 0]]\n", bad)),
                StartsWith("array.toml:2:16: [array]: the place of s1 must be"))
        << bad;
  EXPECT_THAT(error_of("[array]\npositions_m = [[1, 2, 3],\n  [0, 0, 0], [1, 2, 3.0]]\n"),
              StartsWith("array.toml:3:14: [array]: s3 stands where s1 is"));
  std::string seventeen = "[array]\npositions_m = [";
  for (int i = 0; i < 17; ++i) seventeen += fmt::format("[{}, 0, 0],", i);
  EXPECT_THAT(error_of(seventeen + "]\n"), HasSubstr("holds 17 places"));
}

std::string rig(int sensors, const std::string& array, const std::string& rig_keys = "") {
  std::string out = "[rig]\n" + rig_keys + array;
  for (int i = 0; i < sensors; ++i)
    out += fmt::format("[[sensor]]\ndriver = \"obsdaq\"\nport = \"/dev/s{}\"\nprofile = \"mag-13-100\"\n",
                       i + 1);
  return out + "[table]\ndriver = \"hand\"\n[site]\nfield_nT = 50000\n";
}

TEST(ArrayPlaces, OfAConfigurationAreKept) {
  const auto two = parse_config(rig(2, "[array]\npositions_m = [[0, 0, 0], [0, 0, 1]]\n"), "rig.toml");
  ASSERT_TRUE(two) << two.error().lines.front();
  EXPECT_EQ(two->geometry().sensors(), 2U);
  EXPECT_EQ(two->sensors.size(), 2U);
  EXPECT_TRUE(two->warnings.empty()) << two->warnings.front();
}

TEST(ArrayPlaces, ACrossIsACrossHoweverItIsWritten) {
  const auto plain = parse_config(rig(4, "", "baseline_m = 0.6\n"), "rig.toml");
  ASSERT_TRUE(plain) << plain.error().lines.front();
  EXPECT_FALSE(plain->array);
  EXPECT_EQ(plain->geometry(), calib::sensor::Geometry(0.6));
  const auto listed = parse_config(
      rig(4, "[array]\npositions_m = [[0.3, 0, 0], [0, 0.3, 0], [-0.3, 0, 0], [0, -0.3, 0]]\n"), "rig.toml");
  ASSERT_TRUE(listed) << listed.error().lines.front();
  EXPECT_EQ(listed->baseline_m, 0.6);
  EXPECT_EQ(listed->geometry(), plain->geometry());
  for (const char* other : {"[[0.3, 0, 0], [0, 0.3, 0], [-0.3, 0, 0], [0, 0, 0]]",
                            "[[-0.3, 0, 0], [0, -0.3, 0], [0.3, 0, 0], [0, 0.3, 0]]"}) {
    const auto config = parse_config(rig(4, fmt::format("[array]\npositions_m = {}\n", other)), "rig.toml");
    ASSERT_TRUE(config) << config.error().lines.front();
    EXPECT_FALSE(config->geometry().cross_baseline_m()) << other;
    EXPECT_GT(config->baseline_m, 0);
  }
}

TEST(ArrayPlaces, AConfigurationThatContradictsItselfIsRefused) {
  const auto count = parse_config(rig(4, "[array]\npositions_m = [[0, 0, 0], [0, 0, 1]]\n"), "rig.toml");
  ASSERT_FALSE(count);
  EXPECT_THAT(count.error().lines, Contains(HasSubstr("[array] has 2 places, so 2 [[sensor]] sections")));
  const auto both =
      parse_config(rig(1, "[array]\npositions_m = [[0, 0, 0]]\n", "baseline_m = 0.4\n"), "rig.toml");
  ASSERT_FALSE(both);
  EXPECT_THAT(both.error().lines, Contains(StartsWith("rig.toml:3:1: [array]: baseline_m in [rig]")));
  const auto wrong = parse_config(rig(2, "[array]\npositions_m = [[0, 0, 0], [0, 0]]\n"), "rig.toml");
  ASSERT_FALSE(wrong);
  EXPECT_THAT(wrong.error().lines, Contains(StartsWith("rig.toml:3:27: [array]: the place of s2")));
  EXPECT_THAT(wrong.error().lines, Not(Contains(HasSubstr("sections are needed"))));
}

}  // namespace
}  // namespace mgtd::daemon::config
