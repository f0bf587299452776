// SPDX-License-Identifier: Apache-2.0
#include "calib/report/fit_report_text.h"

#include <gmock/gmock.h>

#include <limits>

#include "calib/fit/checks/gauge_text.h"
#include "calib/report/fit_reasons.h"
#include "proto/units.h"

namespace mgtd::calib::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// Readings in a wrong unit, or of a sensor that is off by the field.
TEST(ErrorTable, ColumnsOfLargeErrorsStayApart) {
  fit::FitReport report;
  report.calibration.sensors.resize(4);
  for (fit::ErrorSummary* errors : {&report.before, &report.after_step1, &report.after}) {
    errors->total_field_rmse_nT = {1.25, 53'907.6543, 123'456'789.1,
                                   std::numeric_limits<double>::quiet_NaN()};
    errors->tensor_rmse_nT_per_m.xx = errors->tensor_rmse_nT_per_m.yy = 1'234'567.891;
  }
  const std::string wide = error_table(report, 200), narrow = error_table(report, 80);
  for (const std::string& table : {wide, narrow})
    EXPECT_THAT(table, HasSubstr("       1.250    53908  1.2e+08        -")) << table;
  EXPECT_THAT(wide, HasSubstr("   1234568   1234568"));
}

/// The estimate ends at 10 degrees: it is a lower bound there, and no advice for --table-sd.
TEST(TableAngles, AtTheCeilingOfTheEstimateTheyAreSaidToBeWorse) {
  const std::string rough = rough_table_text(to_rad(3), to_rad(0.1)),
                    useless = rough_table_text(to_rad(10), to_rad(0.1));
  EXPECT_THAT(rough, HasSubstr("--table-sd 3 tells it"));
  EXPECT_THAT(useless, HasSubstr("off by 10 deg a pose or more, where 0.1 deg was told"));
  EXPECT_THAT(useless, Not(HasSubstr("--table-sd")));
  const fit::joint::Gauge gauge{.angles = fit::joint::AngleCoverage::full};
  EXPECT_THAT(fit::checks::gauge_text(gauge, 4, to_rad(10), {}),
              HasSubstr("table angles to 10 deg or more a pose"));
  EXPECT_THAT(fit::checks::gauge_text(gauge, 4, to_rad(3), {}), HasSubstr("table angles to 3 deg a pose"));
}

}  // namespace
}  // namespace mgtd::calib::report
