// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/import_map_file.h"

#include <gmock/gmock.h>

#include <algorithm>

namespace mgtd::daemon::cli {
namespace {

using ::testing::HasSubstr;

TEST(ImportMapFile, UnitsSignsScalesAndOffsetsBecomeOneStep) {
  const auto map = import_map_from_text(R"([columns]
s1_x_nT = {from = "mx", unit = "uT", sign = -1}
s1_T_degC = {from = "t", unit = "K"}
level_nT = {from = "l", scale = 2, offset = 3, unit = "mT"}
battery_V = "v"
)",
                                        "map.toml");
  ASSERT_TRUE(map) << map.error().text();
  ASSERT_EQ(map->columns.size(), 4U);
  const auto column = [&](std::string_view to) {
    return *std::find_if(map->columns.begin(), map->columns.end(), [&](const auto& c) { return c.to == to; });
  };
  EXPECT_EQ(column("s1_x_nT").scale, -1000);
  EXPECT_EQ(column("s1_T_degC").offset, -273.15);
  EXPECT_EQ(column("level_nT").scale + column("level_nT").offset, 5e6);
  EXPECT_EQ(column("battery_V").from, "v");
}

TEST(ImportMapFile, ReadsTimeAndFile) {
  const auto map = import_map_from_text(R"([columns]
s1_x_nT = "3"
[time]
rate_hz = 50
[file]
delimiter = "tab"
header = false
skip = 2
comment = "%"
decimal = ","
every = 5
set = "check"
)",
                                        "map.toml");
  ASSERT_TRUE(map) << map.error().text();
  EXPECT_EQ(map->delimiter, '\t');
  EXPECT_FALSE(map->header);
  EXPECT_EQ(map->skip, 2);
  EXPECT_EQ(map->comment, "%");
  EXPECT_EQ(map->decimal, ',');
  EXPECT_EQ(map->every, 5);
  EXPECT_EQ(map->set, "check");
  ASSERT_TRUE(map->time);
  EXPECT_EQ(map->time->rate_hz, 50);
  const auto utc = import_map_from_text("[columns]\na = \"b\"\n[time]\nfrom = \"t\"\nunit = \"utc\"\n", "m");
  ASSERT_TRUE(utc) << utc.error().text();
  EXPECT_TRUE(utc->time->utc);
}

struct Mistake {
  const char* text;
  const char* what;
};

TEST(ImportMapFile, MistakesAreNamedWithTheirPlace) {
  for (const Mistake& m : {
           Mistake{"", "m:1:1: no column is named"},
           Mistake{"[columns\n", "m:1:"},
           Mistake{"[columns]\na = 3\n", "m:2:1: a: give the name of a column"},
           Mistake{"[columns]\na = {form = \"x\"}\n", "did you mean 'from'?"},
           Mistake{"[columns]\ns1_x_nT = {from = \"x\", unit = \"V\"}\n", "'V' is no unit"},
           Mistake{"[columns]\na = {from = \"x\", sign = 2}\n", "must be 1 or -1"},
           Mistake{"[columns]\na = \"x\"\n[time]\nunit = \"s\"\n",
                   "give either the column `from` or the rate"},
           Mistake{"[columns]\na = \"x\"\n[time]\nfrom = \"t\"\nrate_hz = 5\n", "give either"},
           Mistake{"[columns]\na = \"x\"\n[file]\nevery = 0\n", "must be 1 or more"},
           Mistake{"[columns]\na = \"x\"\n[file]\ndelimiter = \"--\"\n", "must be one character"},
           Mistake{"[colums]\na = \"x\"\n", "'colums' has no meaning here"},
       }) {
    const auto map = import_map_from_text(m.text, "m");
    ASSERT_FALSE(map) << m.text;
    EXPECT_THAT(map.error().message, HasSubstr(m.what)) << m.text;
  }
}

}  // namespace
}  // namespace mgtd::daemon::cli
