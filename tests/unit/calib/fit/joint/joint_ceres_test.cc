// SPDX-License-Identifier: Apache-2.0
// The same least squares written a second time and minimised by Ceres: the reference for the solver.
#include <ceres/ceres.h>
#include <ceres/rotation.h>
#include <gtest/gtest.h>

#include "calib/effects/library/library.h"
#include "calib/fit/joint/joint_fit.h"
#include "tests/unit/calib/fit/simulated_poses.h"

namespace mgtd::calib::fit::joint {
namespace {

using testing::Simulation;

template <class T>
using Vec = Eigen::Matrix<T, 3, 1>;
template <class T>
using Mat = Eigen::Matrix<T, 3, 3>;

/// y = C A M' Ax' Ay' Az' b + I with the rotations as quaternions and the triangular matrix by rows.
template <class T>
Vec<T> reading(const T* p, const Vec<T>& b, const Eigen::Matrix3d& mounting) {
  const auto axis_turn = [](const T& angle, int axis, const Vec<T>& v) {
    T w[3] = {T(0), T(0), T(0)};
    w[axis] = angle;  // undoing a passive turn by the angle is an active turn by it
    Vec<T> out;
    ceres::AngleAxisRotatePoint(w, v.data(), out.data());
    return out;
  };
  const Vec<T> s =
      mounting.transpose().cast<T>() *
      axis_turn(p[sensor::alpha], 0, axis_turn(p[sensor::beta], 1, axis_turn(p[sensor::gamma], 2, b)));
  using std::cos, std::sin;
  return {p[sensor::cx] * (cos(p[sensor::theta]) * cos(p[sensor::phi]) * s[0] +
                           sin(p[sensor::theta]) * cos(p[sensor::phi]) * s[1] + sin(p[sensor::phi]) * s[2]) +
              p[sensor::ix],
          p[sensor::cy] * (cos(p[sensor::psi]) * s[1] + sin(p[sensor::psi]) * s[2]) + p[sensor::iy],
          p[sensor::cz] * s[2] + p[sensor::iz]};
}

struct PoseCost {
  const JointPose* pose;
  PerSensor<Eigen::Matrix3d> mounting;
  PerSensor<Eigen::Vector3d> r;
  /// Sensors s1..s4, site (inclination, declination), gradient, attitude error, field strength.
  template <class T>
  bool operator()(const T* s1, const T* s2, const T* s3, const T* s4, const T* site, const T* g, const T* w,
                  const T* f, T* e) const {
    using std::cos, std::sin;
    const Vec<T> B{f[0] * cos(site[0]) * cos(site[1]), f[0] * cos(site[0]) * sin(site[1]),
                   f[0] * sin(site[0])};
    Mat<T> G;
    G << g[0], g[2], g[3], g[2], g[1], g[4], g[3], g[4], -g[0] - g[1];
    // A passive turn by w: the quaternion of -w/2.
    const T q[4] = {T(1), -w[0] / 2.0, -w[1] / 2.0, -w[2] / 2.0};
    Mat<T> E;
    for (int j = 0; j < 3; ++j) {
      Vec<T> unit = Vec<T>::Zero();
      unit[j] = T(1);
      Vec<T> column;
      ceres::QuaternionRotatePoint(q, unit.data(), column.data());
      E.col(j) = column;
    }
    const Mat<T> R = E * pose->T.cast<T>();
    const T* sensors[] = {s1, s2, s3, s4};
    for (int i = 0; i < kSensors; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const Vec<T> b = R * (B + G * (R.transpose() * r[at].cast<T>()));
      const Vec<T> y = reading(sensors[i], b, mounting[at]);
      for (int a = 0; a < 3; ++a) e[3 * i + a] = pose->weight[3 * i + a] * (pose->y_nT[3 * i + a] - y[a]);
    }
    e[12] = pose->f_weight * (pose->f_nT - f[0]);
    for (int j = 0; j < 3; ++j) e[13 + j] = pose->attitude_weight * w[j];
    return true;
  }
};

double ceres_cost(const JointFit& fit, bool with_gradient, std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  PerSensor<sensor::ParameterVector> sensors;
  std::array<double, 2> site{std::asin(fit.state.direction[2]),
                             std::atan2(fit.state.direction[1], fit.state.direction[0])};
  std::array<double, 5> g{};
  std::vector<Nuisance> nuisances = fit.state.nuisances;
  ceres::Problem problem;
  PoseCost cost{nullptr, {}, fit.problem.geometry.positions_P_m()};
  for (std::size_t i = 0; i < kSensors; ++i) {
    // Away from the optimum, so that Ceres has to find its own way.
    sensors[i] = fit.state.sensors[i].parameters();
    for (int p = 0; p < sensor::kSensorParameters; ++p)
      sensors[i][p] += (p >= sensor::ix && p <= sensor::iz ? 20 : 1e-3) * normal(rng);
    cost.mounting[i] = fit.state.sensors[i].mounting;
  }
  for (std::size_t k = 0; k < nuisances.size(); ++k) {
    cost.pose = &fit.problem.poses[k];
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<PoseCost, 16, 12, 12, 12, 12, 2, 5, 3, 1>(new PoseCost(cost)),
        nullptr, sensors[0].data(), sensors[1].data(), sensors[2].data(), sensors[3].data(), site.data(),
        g.data(), nuisances[k].data(), nuisances[k].data() + 3);
  }
  if (!with_gradient) problem.SetParameterBlockConstant(g.data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.function_tolerance = 1e-15;
  options.parameter_tolerance = 1e-15;
  options.gradient_tolerance = 1e-12;
  options.max_num_iterations = 100;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return 2 * summary.final_cost;
}

TEST(JointFit, AgreesWithCeres) {
  for (const bool with_gradient : {false, true}) {
    Simulation sim{.table_sd_rad = to_rad(0.1), .f_sd_nT = 0.05};
    JointOptions options;
    if (with_gradient) {
      sim.G_nT_per_m = testing::gradient_50();
      options.effects = {*effects::library::make_effect("site.gradient")};
    }
    sim.rig[3].mounting << 0, -1, 0, 1, 0, 0, 0, 0, 1;
    const PoseTable table = simulate(sim, 20, 60, 23);
    const auto fit = fit_joint(table, options);
    ASSERT_TRUE(fit) << fit.error().text();
    const double ours = reduce(fit->problem, fit->state, 0).cost.total();
    std::mt19937_64 rng(29);
    const double theirs = ceres_cost(*fit, with_gradient, rng);
    EXPECT_NEAR(ours / theirs, 1, 1e-9) << "gradient " << with_gradient;
  }
}

}  // namespace
}  // namespace mgtd::calib::fit::joint
