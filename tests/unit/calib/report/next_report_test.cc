// SPDX-License-Identifier: Apache-2.0
#include "calib/report/next_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace mgtd::calib::report {
namespace {

using criticism::search::Finding;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// What explain() left without an open question.
criticism::search::NextReport nothing_open(Finding finding) {
  return {.nothing_to_settle = criticism::search::NothingToSettle{}, .finding = finding};
}

TEST(NextReport, HasAlwaysAStepWhereSomethingIsLeftUnexplained) {
  for (const Finding finding : {Finding::unknown, Finding::partial}) {
    const std::string text = to_text(nothing_open(finding));
    EXPECT_THAT(text, AllOf(HasSubstr(std::string(to_string(finding))), HasSubstr("mgt discover"),
                            HasSubstr("mgt define"), Not(HasSubstr("nothing to settle")),
                            Not(HasSubstr("nothing stands out"))));
    EXPECT_EQ(to_json(nothing_open(finding)).at("text").get<std::string>() + "\n", text);
  }
}

TEST(NextReport, SendsBackToTheReadingsWhereTheyContradictEachOther) {
  EXPECT_THAT(to_text(nothing_open(Finding::bad_data)),
              AllOf(HasSubstr("BAD-DATA"), Not(HasSubstr("nothing to settle"))));
}

TEST(NextReport, HasNothingToSettleOnACleanRun) {
  EXPECT_THAT(to_text(nothing_open(Finding::pass)), HasSubstr("there is nothing to settle"));
}

}  // namespace
}  // namespace mgtd::calib::report
