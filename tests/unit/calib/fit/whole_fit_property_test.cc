// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <numbers>
#include <random>

#include "calib/calibration/apply.h"
#include "calib/fit/method_choice/fit.h"
#include "tests/unit/calib/fit/simulated_poses.h"

/// What holds of the whole fit for every array: one to six sensors at random places, with random parameters.
/// MGTD_FIT_CASES sets how many arrays each property is tried on.
namespace mgtd::calib {
namespace {

constexpr int kFewCases = 5;
constexpr double kField_nT = 50'000;
/// Of two answers that differ by rounding and by where the iterations stop; of parameters without unit and
/// rad.
constexpr double kSame_nT = 1e-3, kSame = 1e-7;

/// As rc::check, with as many cases as asked for.
bool holds(const std::function<void()>& property) {
  rc::detail::TestParams params = rc::detail::configuration().testParams;
  const char* const asked = std::getenv("MGTD_FIT_CASES");
  params.maxSuccess = asked != nullptr ? std::max(1, std::atoi(asked)) : kFewCases;
  const auto result = rc::detail::checkTestable(property, rc::detail::TestMetadata(), params);
  rc::detail::printResultMessage(result, std::cerr);
  return result.is<rc::detail::SuccessResult>();
}

/// An array and everything random about it, from one seed.
class Case {
 public:
  explicit Case(std::size_t fewest)
      : random_(*rc::gen::resize(rc::kNominalSize, rc::gen::inRange<std::uint64_t>(1, 1'000'000))),
        sensors_(*rc::gen::resize(rc::kNominalSize, rc::gen::inRange<std::size_t>(fewest, 7))) {
    places.resize(sensors_);
    rig.resize(sensors_);
    for (std::size_t i = 0; i < rig.size(); ++i) {
      places[i] = 0.3 * vector();
      rig[i] = testing::sensor(2 * uniform(), 2 * uniform(), 2 * uniform(),
                               Eigen::Vector3d::Ones() + 0.1 * vector(), 300 * vector(), 3 * uniform(),
                               3 * uniform(), 3 * uniform());
    }
    for (int k = 0; k < kPoses; ++k)
      attitudes.push_back({std::numbers::pi * uniform(), std::asin(uniform()), std::numbers::pi * uniform()});
  }

  [[nodiscard]] std::size_t sensors() const { return rig.size(); }
  double uniform() { return std::uniform_real_distribution<double>(-1, 1)(random_); }
  Eigen::Vector3d vector() {
    const double x = uniform(), y = uniform(), z = uniform();
    return {x, y, z};
  }
  Eigen::Matrix3d rotation() {
    return Eigen::AngleAxisd(std::numbers::pi * uniform(), vector().normalized()).toRotationMatrix();
  }
  Eigen::Matrix3d gradient() {
    const double xx = uniform(), yy = uniform(), xy = uniform(), xz = uniform(), yz = uniform();
    return 100 * Eigen::Matrix3d{{xx, xy, xz}, {xy, yy, yz}, {xz, yz, -xx - yy}};
  }

  /// Readings in the field B + G r of each pose, in the platform frame; noise of each reading.
  PoseTable measured(const Eigen::Matrix3d& G_P, double noise_nT) {
    std::normal_distribution<double> normal(0, noise_nT);
    PoseTable table;
    const Eigen::Vector3d B_S = kField_nT * Eigen::Vector3d(0.5, 0.1, 0.8).normalized();
    for (std::size_t k = 0; k < attitudes.size(); ++k) {
      Pose pose;
      pose.number = static_cast<int>(k) + 1;
      pose.y_nT.resize(sensors());
      pose.sd_nT.resize(sensors());
      pose.T_degC.resize(sensors());
      for (std::size_t i = 0; i < sensors(); ++i) {
        pose.y_nT[i] = rig[i].predict(testing::attitude(attitudes[k]) * B_S + G_P * places[i]);
        if (noise_nT > 0)
          for (double& y : pose.y_nT[i]) y += normal(random_);
      }
      for (auto& sd : pose.sd_nT) sd.fill(noise_nT);
      pose.n = pose.n_eff = 1;
      pose.f_nT = kField_nT;
      pose.f_sd_nT = 0.01;
      pose.azimuth_rad = attitudes[k].azimuth_rad;
      pose.pitch_rad = attitudes[k].pitch_rad;
      pose.roll_rad = attitudes[k].roll_rad;
      table.poses.push_back(std::move(pose));
    }
    return table;
  }

  [[nodiscard]] calibration::Calibration fitted(const PoseTable& table) const {
    fit::FitOptions options;
    options.geometry = sensor::Geometry(places);
    const auto report = fit::method_choice::fit(table, options);
    if (!report) RC_FAIL(report.error().text());
    return report->calibration;
  }

  /// Across the array where it is thinnest of the two directions that its gradient needs.
  [[nodiscard]] double smallest_extent_m() const {
    Eigen::Matrix3Xd r(3, static_cast<Eigen::Index>(sensors()));
    for (std::size_t i = 0; i < sensors(); ++i) r.col(static_cast<Eigen::Index>(i)) = places[i];
    return (r.colwise() - Eigen::Vector3d(r.rowwise().mean())).jacobiSvd().singularValues()[1];
  }

  PerSensor<Eigen::Vector3d> places{std::size_t{0}};
  testing::Rig rig;
  std::vector<TableAngles> attitudes;

 private:
  static constexpr int kPoses = 60;
  std::mt19937_64 random_;
  std::size_t sensors_;
};

Eigen::Matrix3d tensor_of(const Gradient& g) {
  return Eigen::Matrix3d{{g.xx, g.xy, g.xz}, {g.xy, g.yy, g.yz}, {g.xz, g.yz, g.zz}};
}

std::vector<calibration::AppliedPose> applied(const calibration::Calibration& c, const PoseTable& table) {
  auto rows = calibration::apply(c, table);
  if (!rows) RC_FAIL(rows.error().text());
  return *std::move(rows);
}

TEST(WholeFit, RelabellingTheSensorsPermutesTheAnswer) {
  EXPECT_TRUE(holds([] {
    Case array(1);
    const PoseTable table = array.measured(Eigen::Matrix3d::Zero(), 1);
    const calibration::Calibration before = array.fitted(table);
    const std::size_t n = array.sensors();
    const auto old = [n](std::size_t i) { return (i + 1) % n; };  // a permutation without a fixed point
    Case other = array;
    PoseTable relabelled = table;
    for (std::size_t i = 0; i < n; ++i) {
      other.places[i] = array.places[old(i)];
      for (std::size_t k = 0; k < table.poses.size(); ++k)
        relabelled.poses[k].y_nT[i] = table.poses[k].y_nT[old(i)];
    }
    const calibration::Calibration after = other.fitted(relabelled);
    for (std::size_t i = 0; i < n; ++i) {
      const Eigen::VectorXd off = after.sensors[i].parameters() - before.sensors[old(i)].parameters();
      RC_ASSERT(off.segment<3>(sensor::ix).norm() < kSame_nT);
      RC_ASSERT(off.norm() - off.segment<3>(sensor::ix).norm() < kSame);
    }
  }));
}

/// Array, sensors and table angles in a frame that is turned by Q: fields and gradients turn with it.
TEST(WholeFit, TurningTheArrayTurnsTheAnswer) {
  EXPECT_TRUE(holds([] {
    Case array(1);
    const PoseTable table = array.measured(Eigen::Matrix3d::Zero(), 1);
    const PoseTable seen = array.measured(array.gradient(), 0);
    const Eigen::Matrix3d Q = array.rotation();
    Case other = array;
    for (Eigen::Vector3d& place : other.places) place = Q * place;
    const auto turned = [&](PoseTable poses) {
      for (std::size_t k = 0; k < poses.poses.size(); ++k) {
        const Eigen::Vector3d angles = (Q * testing::attitude(array.attitudes[k])).eulerAngles(2, 1, 0);
        poses.poses[k].azimuth_rad = -angles[0];
        poses.poses[k].pitch_rad = -angles[1];
        poses.poses[k].roll_rad = -angles[2];
      }
      return poses;
    };
    const auto before = applied(array.fitted(table), seen);
    const auto after = applied(other.fitted(turned(table)), turned(seen));
    for (std::size_t k = 0; k < before.size(); ++k) {
      for (std::size_t i = 0; i < array.sensors(); ++i) {
        const auto at = static_cast<Eigen::Index>(3 * i);
        RC_ASSERT((after[k].b_P_nT.segment<3>(at) - Q * before[k].b_P_nT.segment<3>(at)).norm() < kSame_nT);
      }
      if (array.sensors() < 3) continue;
      const Eigen::Matrix3d G = Q * tensor_of(before[k].sample.g_nT_per_m) * Q.transpose();
      RC_ASSERT((tensor_of(after[k].sample.g_nT_per_m) - G).norm() < kSame_nT / array.smallest_extent_m());
    }
  }));
}

TEST(WholeFit, AUniformFieldGivesNoGradientAndALinearFieldGivesItsOwn) {
  EXPECT_TRUE(holds([] {
    Case array(3);
    const PoseTable uniform = array.measured(Eigen::Matrix3d::Zero(), 0);
    const calibration::Calibration c = array.fitted(uniform);
    const double limit = kSame_nT / array.smallest_extent_m();
    for (const auto& row : applied(c, uniform)) RC_ASSERT(tensor_of(row.sample.g_nT_per_m).norm() < limit);
    const Eigen::Matrix3d G = array.gradient();
    for (const auto& row : applied(c, array.measured(G, 0)))
      RC_ASSERT((tensor_of(row.sample.g_nT_per_m) - G).norm() < limit);
  }));
}

/// On readings that the fit has not seen, in a field with a gradient.
TEST(WholeFit, ClosureHasItsChiSquare) {
  EXPECT_TRUE(holds([] {
    Case array(3);
    const calibration::Calibration c = array.fitted(array.measured(Eigen::Matrix3d::Zero(), 1));
    const int dof = 3 * static_cast<int>(array.sensors()) - 8;
    constexpr int kTables = 10;
    double sum = 0, count = 0;
    for (int t = 0; t < kTables; ++t) {
      for (const auto& row : applied(c, array.measured(array.gradient(), 1))) {
        RC_ASSERT(row.sample.closure.dof == dof);
        sum += row.sample.closure.chi2, ++count;
      }
    }
    // What 60 poses leave uncertain of each channel's four parameters adds 1/15 to the variance of new ones.
    const double expected = dof * (1 + 1 / 15.0), by_calibration = 0.15 * dof;
    RC_ASSERT(std::abs(sum / count - expected) < 5 * std::sqrt(2 * dof / count) + by_calibration);
  }));
}

}  // namespace
}  // namespace mgtd::calib
