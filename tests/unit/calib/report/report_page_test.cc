// SPDX-License-Identifier: Apache-2.0
#include "calib/report/report_page.h"

#include <gmock/gmock.h>

#include "calib/criticism/tests/comparison.h"
#include "tests/unit/calib/fit/fitted_arrays.h"

namespace mgtd::calib::report {
namespace {

using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// Of one sensor alone, without figures.
ReportContent content_of_one_sensor() {
  const testing::Places places = testing::one_sensor();
  PoseTable table = testing::turned_run(places, 3);
  fit::FitReport fit = testing::fitted(table, places);
  auto comparison = criticism::tests::compare(table, testing::options_of(places));
  if (!comparison) throw std::runtime_error(comparison.error().text());
  criticism::search::ExplainReport explained = testing::explained(table, places);
  return {.run = "run.csv",
          .table = std::move(table),
          .fit = std::move(fit),
          .comparison = *std::move(comparison),
          .explained = std::move(explained)};
}

/// What one sensor cannot tell is absent; what two on a line cannot tell is a dash.
TEST(ReportPage, ShowsNoTensorThatTheArrayDoesNotDetermine) {
  ReportContent c = content_of_one_sensor();
  EXPECT_THAT(errors_section(c), Not(AnyOf(HasSubstr("nan"), HasSubstr("nT/m"), HasSubstr("tensor"))));
  EXPECT_THAT(report_page(c), Not(HasSubstr("The tensor's standard error")));
  for (fit::ErrorSummary* e : {&c.fit.before, &c.fit.after, &*c.fit.held_out})
    e->tensor_rmse_nT_per_m.zz = 0.25;
  EXPECT_THAT(errors_section(c),
              AllOf(HasSubstr(">xx</th>"), HasSubstr("<td>-</td><td>0.250</td>"), Not(HasSubstr("nan"))));
}

TEST(ReportPage, TellsWhatTheRunFileKeeps) {
  ReportContent c = content_of_one_sensor();
  EXPECT_THAT(measured_section(c), Not(AnyOf(HasSubstr("masked"), HasSubstr("<td>run</td>"))));
  EXPECT_THAT(history_section(c), HasSubstr("keeps no steps"));
  EXPECT_EQ(judgements_section(c), "");
  c.file.run = "r7 on rig <x>";
  c.file.masked = {.head = {"pose", "because"}, .rows = {{"12", "a car <stood> there"}, {"40", "door open"}}};
  c.file.judgements = {.head = {"poses", "what they said"}, .rows = {{"157", "AMBIGUOUS"}}};
  c.file.history = {.head = {"step", "reason"}, .rows = {{"mask", "a car"}}};
  EXPECT_THAT(measured_section(c),
              AllOf(HasSubstr("<td>r7 on rig &lt;x&gt;</td>"), HasSubstr("; 2 more masked by the operator"),
                    HasSubstr("a car &lt;stood&gt; there"), HasSubstr("door open")));
  EXPECT_THAT(judgements_section(c), HasSubstr("<td>AMBIGUOUS</td>"));
  EXPECT_THAT(history_section(c), HasSubstr("<td>a car</td>"));
}

}  // namespace
}  // namespace mgtd::calib::report
