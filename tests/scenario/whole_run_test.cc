// SPDX-License-Identifier: Apache-2.0
// A whole calibration run through the real drivers on simulated instruments, in virtual time.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "calib/fit/method_choice/fit.h"
#include "calib/report/fit_reasons.h"
#include "tests/scenario/virtual_daemon.h"

namespace mgtd {
namespace {

using namespace mgtd::daemon;
using test::scenario_of;
using test::VirtualDaemon;

/// The truth under the paper's names, in the fit's units and order.
calib::sensor::ParameterVector truth_of(const rig::SensorTruth& s) {
  calib::sensor::ParameterVector p;
  p << to_rad(s.theta_deg), to_rad(s.phi_deg), to_rad(s.psi_deg), s.scale, s.offset_nT, to_rad(s.alpha_deg),
      to_rad(s.beta_deg), to_rad(s.gamma_deg);
  return p;
}

/// Fits like the daemon does and keeps the report.
void fit_with(VirtualDaemon& daemon, std::optional<calib::fit::FitReport>& report,
              calib::fit::FitOptions options = {}) {
  daemon.solver = [&report, options](const PoseTable& poses) -> Result<daemon::run::Solution> {
    auto fitted = calib::fit::method_choice::fit(poses, options);
    if (!fitted) return tl::unexpected(fitted.error());
    report = *fitted;
    const calib::calibration::Calibration& c = fitted->calibration;
    return daemon::run::Solution{c.accepted_by_checks, c.id, calib::report::fit_reasons(*fitted), c.checks};
  };
}

/// Switches on, plans, runs to the end.
void whole_run(VirtualDaemon& daemon, const daemon::plan::PlanOptions& options) {
  ASSERT_TRUE(daemon.run(60, [&] { return daemon.all_live(); }));
  const auto plan = daemon::plan::make_plan(options, daemon.table().limits());
  ASSERT_TRUE(plan) << plan.error().text();
  daemon.start(*plan);
  ASSERT_TRUE(daemon.run(4 * 3600)) << daemon.status->message;
}

/// Error of each of the 48 parameters in units of its reported standard error.
std::vector<double> errors_in_sd(const calib::calibration::Calibration& found, const rig::RigTruth& truth) {
  std::vector<double> z;
  for (int i = 0; i < kSensors; ++i) {
    const auto slot = static_cast<std::size_t>(i);
    const calib::sensor::ParameterVector error = found.sensors[slot].parameters() - truth_of(truth[slot]);
    for (int p = 0; p < calib::sensor::kSensorParameters; ++p) {
      const int at = i * calib::sensor::kSensorParameters + p;
      z.push_back(error[p] / std::sqrt(found.covariance(at, at)));
    }
  }
  return z;
}

double largest(const std::vector<double>& z) {
  double most = 0;
  for (const double v : z) most = std::isfinite(v) ? std::max(most, std::abs(v)) : 1e9;
  return most;
}

TEST(WholeRun, Table6RigIsFoundWithinItsStandardErrors) {
  const auto scenario = scenario_of("[rig]\nname = \"table6\"\nparameters = \"table6\"\nseed = 6\n");
  VirtualDaemon daemon(scenario);
  std::optional<calib::fit::FitReport> report;
  fit_with(daemon, report);
  whole_run(daemon, {});
  ASSERT_TRUE(daemon.finished);
  ASSERT_EQ(name(daemon.finished->state), "done") << daemon.finished->message;
  EXPECT_EQ(daemon.poses.poses.size(), 157u);
  EXPECT_EQ(daemon.status->retries, 0) << fmt::format("{}", fmt::join(daemon.records, "\n"));
  EXPECT_TRUE(daemon.notes.empty()) << daemon.notes[0];
  RecordProperty("simulated_s", fmt::format("{:.0f}", daemon.t_s));

  // Gauge: the platform frame is the table's frame, by the poses whose three angles are known.
  ASSERT_TRUE(report);
  EXPECT_NE(report->calibration.gauge.find("platform frame is the table frame"), std::string::npos)
      << report->calibration.gauge;
  const double worst = largest(errors_in_sd(report->calibration, scenario.truth));
  RecordProperty("worst_error_in_sd", fmt::format("{:.2f}", worst));
  EXPECT_LT(worst, 4.5);
  // A planted error of six standard errors must be seen.
  calib::calibration::Calibration planted = report->calibration;
  planted.sensors[2].scale.y() +=
      6 * std::sqrt(planted.covariance(24 + calib::sensor::cy, 24 + calib::sensor::cy));
  EXPECT_GT(largest(errors_in_sd(planted, scenario.truth)), 4.5 - 1.5);
}

TEST(WholeRun, RandomRigsAreFoundWithinTheirStandardErrors) {
  double square = 0;
  int count = 0;
  for (int seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    const auto scenario =
        scenario_of(fmt::format("[rig]\nname = \"random\"\nparameters = \"random\"\nseed = {}\n", seed));
    VirtualDaemon daemon(scenario);
    std::optional<calib::fit::FitReport> report;
    fit_with(daemon, report);
    whole_run(daemon, {.seed = static_cast<std::uint64_t>(seed)});
    ASSERT_TRUE(daemon.finished && report) << daemon.finished->message;
    EXPECT_EQ(name(daemon.finished->state), "done") << daemon.finished->message;
    const auto z = errors_in_sd(report->calibration, scenario.truth);
    EXPECT_LT(largest(z), 4.5);
    for (const double v : z) square += v * v;
    count += static_cast<int>(z.size());
  }
  // Mean of 192 squared errors in sd; about 100 of them independent: 1 +- 0.14.
  RecordProperty("mean_square_error_in_sd", fmt::format("{:.2f}", square / count));
  EXPECT_GT(square / count, 0.5);
  EXPECT_LT(square / count, 1.6);
}

TEST(WholeRun, WorksWithoutAScalarReference) {
  const auto scenario = scenario_of(
      "[rig]\nname = \"no-scalar\"\nparameters = \"table6\"\nseed = 3\n[scalar]\npresent = false\n");
  VirtualDaemon daemon(scenario);
  std::optional<calib::fit::FitReport> report;
  calib::fit::FitOptions options;
  options.field_nT = scenario.f_nT;
  fit_with(daemon, report, options);
  whole_run(daemon, {});
  ASSERT_TRUE(daemon.finished && report);
  EXPECT_EQ(name(daemon.finished->state), "done") << daemon.finished->message;
  EXPECT_FALSE(daemon.poses.poses[0].f_nT);
  EXPECT_LT(largest(errors_in_sd(report->calibration, scenario.truth)), 4.5);
}

TEST(WholeRun, TableOfOneAxisEndsInARefusalThatSaysWhatToDo) {
  const auto scenario =
      scenario_of("[rig]\nname = \"flat\"\nparameters = \"table6\"\n[table]\ntilt_limit_deg = 0\n");
  VirtualDaemon daemon(scenario);
  std::optional<calib::fit::FitReport> report;
  fit_with(daemon, report);
  whole_run(daemon, {.step_deg = 20, .random = 12, .revisits = 2});
  ASSERT_TRUE(daemon.finished);
  EXPECT_EQ(name(daemon.finished->state), "rejected") << daemon.finished->message;
  EXPECT_NE(daemon.finished->message.find("axis"), std::string::npos) << daemon.finished->message;
}

}  // namespace
}  // namespace mgtd
