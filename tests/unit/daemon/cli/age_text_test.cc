// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/age_text.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace mgtd::daemon::cli {
namespace {

using nlohmann::json;

TEST(AgeText, HasOneUnitOfWhichThereAreTwo) {
  EXPECT_EQ(age_text(-1), "0 s");
  EXPECT_EQ(age_text(119.9), "119 s");
  EXPECT_EQ(age_text(120), "2 min");
  EXPECT_EQ(age_text(7199), "119 min");
  EXPECT_EQ(age_text(7200), "2 h");
  EXPECT_EQ(age_text(2 * 86'400 - 1), "47 h");
  EXPECT_EQ(age_text(40 * 86'400.0), "40 days");
}

TEST(ConditionsText, SaysHowFarItIsFromThoseOfTheRun) {
  EXPECT_EQ(conditions_text(json::parse(
                R"({"age_s":259200,"made_at_degC":[12.31,null,11.87],"now_degC":[31.02,31.04,30.98]})")),
            "made 3 days ago at 11.9 to 12.3 degC, now 31.0 degC");
}

TEST(ConditionsText, LeavesOutWhatIsNotKnown) {
  EXPECT_EQ(conditions_text(json::parse(R"({"age_s":9,"made_at_degC":[null],"now_degC":[31.0]})")),
            "made 9 s ago");
  EXPECT_EQ(conditions_text(json::parse(R"({"age_s":null,"made_at_degC":[12],"now_degC":[null]})")),
            "made at 12.0 degC");
  EXPECT_EQ(conditions_text(json::parse(R"({"age_s":null,"made_at_degC":null,"now_degC":null})")), "");
  EXPECT_EQ(conditions_text(json::parse(R"({"forced":false})")), "") << "an earlier daemon";
}

}  // namespace
}  // namespace mgtd::daemon::cli
