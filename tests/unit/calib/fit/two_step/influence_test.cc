// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/two_step/influence.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "calib/fit/method_choice/fit.h"
#include "tests/support/paper_rigs.h"

/// Stated uncertainties against what many runs scatter by. Every run is measured anew: other noise, other
/// errors of the table, the same attitudes.
namespace mgtd::calib::fit::two_step {
namespace {

using mgtd::testing::Noise;
using mgtd::testing::RigTruth;
constexpr int kRuns = 250;

using Vector = Eigen::Matrix<double, calibration::kArrayParameters, 1>;

Vector truth_of(const RigTruth& rig) {
  Vector out;
  for (std::size_t i = 0; i < 4; ++i) {
    for (int k = 0; k < sensor::kSensorParameters; ++k) {
      const double shown = rig.at(i).at(static_cast<std::size_t>(k));
      out[static_cast<int>(i) * sensor::kSensorParameters + k] =
          k <= sensor::psi || k >= sensor::alpha ? to_rad(shown) : shown;
    }
  }
  return out;
}

Vector estimate_of(const calibration::Calibration& c) {
  Vector out;
  for (int i = 0; i < kSensors; ++i)
    out.segment<sensor::kSensorParameters>(i * sensor::kSensorParameters) =
        c.sensors.at(static_cast<std::size_t>(i)).parameters();
  return out;
}

FitOptions two_step_options() {
  FitOptions options;
  options.method = Method::two_step;
  return options;
}

struct Honesty {
  double nees{0};                ///< mean of e' C^-1 e over the runs; 48 when C is the real covariance
  Vector ratio{Vector::Zero()};  ///< rms error over stated sd, per parameter
  double declination{0}, inclination{0};
};

Honesty honesty(const Noise& noise, const FitOptions& options, const mgtd::testing::Site& site) {
  const RigTruth rig = mgtd::testing::table6_rig();
  const Vector truth = truth_of(rig);
  Honesty out;
  for (int run = 0; run < kRuns; ++run) {
    const PoseTable table = mgtd::testing::measure(rig, site, mgtd::testing::standard_run(121, 5), 36, noise,
                                                   1000 + static_cast<std::uint64_t>(run));
    const auto report = method_choice::fit(table, options);
    if (!report) throw std::runtime_error(report.error().text());
    const Eigen::MatrixXd& C = report->calibration.covariance;
    const Vector sd = C.diagonal().cwiseSqrt();
    const Vector e = (estimate_of(report->calibration) - truth).cwiseQuotient(sd);
    const Eigen::MatrixXd unit = sd.cwiseInverse().asDiagonal() * C * sd.cwiseInverse().asDiagonal();
    out.nees += e.dot(unit.llt().solve(e)) / kRuns;
    out.ratio += e.cwiseAbs2() / kRuns;
    const SiteField& s = report->site;
    out.declination +=
        std::pow((s.declination_rad - to_rad(site.declination_deg)) / s.declination_sd_rad, 2) / kRuns;
    out.inclination +=
        std::pow((s.inclination_rad - to_rad(site.inclination_deg)) / s.inclination_sd_rad, 2) / kRuns;
  }
  return out;
}

/// The mean of kRuns chi-squares of 48 degrees scatters by sqrt(2 48 / kRuns); five of that. A variance ratio
/// by sqrt(2 / kRuns) = 9 %; five of that, for the worst of 48.
const double kBand = 5 * std::sqrt(2.0 * calibration::kArrayParameters / kRuns);
const double kVarianceBand = 5 * std::sqrt(2.0 / kRuns);

void expect_honest(const Honesty& h) {
  EXPECT_NEAR(h.nees, calibration::kArrayParameters, kBand);
  EXPECT_LT(h.ratio.maxCoeff(), 1 + kVarianceBand);
  EXPECT_GT(h.ratio.minCoeff(), 1 - kVarianceBand);
}

constexpr mgtd::testing::Site kSite{53'907.7, 60, -5};

TEST(Influence, IsTheScatterOfManyRunsWithAPoorTable) {
  const Honesty h = honesty({Noise::Kind::gaussian, 0.5, 0.1, 0.1}, two_step_options(), kSite);
  expect_honest(h);
  EXPECT_NEAR(h.declination, 1, kVarianceBand);
  EXPECT_NEAR(h.inclination, 1, kVarianceBand);
}

TEST(Influence, IsTheScatterOfManyRunsWhereTheReadingsDominate) {
  FitOptions options = two_step_options();
  options.table_sd_rad = to_rad(0.001);
  expect_honest(honesty({Noise::Kind::gaussian, 5, 0.001, 2}, options, kSite));
}

TEST(Influence, IsTheScatterOfManyRunsWithAGivenDeclination) {
  FitOptions options = two_step_options();
  options.declination_rad = to_rad(-5.0);
  expect_honest(honesty({Noise::Kind::gaussian, 0.5, 0.1, 0.1}, options, kSite));
}

TEST(Influence, IsTheScatterOfManyRunsWhereTheFieldPointsUp) {
  expect_honest(honesty({Noise::Kind::gaussian, 0.5, 0.1, 0.1}, two_step_options(), {48'000, -40, 12}));
}

/// A covariance without the table's errors is not honest: the test above can fail.
TEST(Influence, LeavingTheTableOutIsNoticed) {
  FitOptions options = two_step_options();
  options.table_sd_rad = to_rad(0.05);
  const Honesty h = honesty({Noise::Kind::gaussian, 0.5, 0.1, 0.1}, options, kSite);
  EXPECT_GT(h.nees, calibration::kArrayParameters + kBand);
}

/// One field for all poses, wrong by its stated uncertainty: every scale factor is wrong alike.
TEST(Influence, AGivenFieldIsOneErrorCommonToAllPoses) {
  PoseTable table =
      mgtd::testing::measure(mgtd::testing::table6_rig(), kSite, mgtd::testing::standard_run(121, 5), 36,
                             {Noise::Kind::gaussian, 0.01, 0}, 1);
  for (Pose& pose : table.poses) pose.f_nT.reset();
  FitOptions options = two_step_options();
  options.field_nT = kSite.f_nT;
  options.field_sd_nT = 20;
  const auto report = method_choice::fit(table, options);
  ASSERT_TRUE(report);
  const Eigen::MatrixXd& C = report->calibration.covariance;
  const int a = sensor::cx, b = 2 * sensor::kSensorParameters + sensor::cz;
  EXPECT_NEAR(std::sqrt(C(a, a)), 0.999 * 20 / kSite.f_nT, 1e-6);
  EXPECT_NEAR(C(a, b) / std::sqrt(C(a, a) * C(b, b)), 1, 1e-3);
}

/// Without tilted poses and without a declination the mean of gamma is zero by convention: it has no error.
TEST(Influence, TheConventionOfMeanGammaHasNoError) {
  PoseTable table =
      mgtd::testing::measure(mgtd::testing::table6_rig(), kSite, mgtd::testing::standard_run(121, 5), 36,
                             {Noise::Kind::gaussian, 0.5, 0.1}, 1);
  for (Pose& pose : table.poses) {
    if (pose.set != "standard") pose.azimuth_rad.reset(), pose.pitch_rad.reset(), pose.roll_rad.reset();
  }
  const auto report = method_choice::fit(table, two_step_options());
  ASSERT_TRUE(report) << report.error().text();
  Vector mean = Vector::Zero();
  double sum = 0;
  for (int i = 0; i < kSensors; ++i) {
    mean[i * sensor::kSensorParameters + sensor::gamma] = 0.25;
    sum += report->calibration.sensors.at(static_cast<std::size_t>(i)).gamma_rad / 4;
  }
  EXPECT_NEAR(sum, 0, 1e-5);  // mean of sines against mean of angles: gamma^3
  EXPECT_NEAR(mean.dot(report->calibration.covariance * mean), 0, 1e-14);
  EXPECT_GT(report->calibration.covariance(sensor::gamma, sensor::gamma), 0);
}

}  // namespace
}  // namespace mgtd::calib::fit::two_step
