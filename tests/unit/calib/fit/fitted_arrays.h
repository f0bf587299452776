// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Cholesky>
#include <cmath>
#include <stdexcept>

#include "calib/calibration/calibration.h"
#include "calib/criticism/search/explain.h"
#include "calib/fit/method_choice/fit.h"
#include "tests/unit/calib/fit/arrays_of_any_size.h"

/// Fits of simulated arrays, and what their errors say about the stated uncertainties.
namespace mgtd::calib::testing {

inline fit::FitOptions options_of(const Places& places) {
  fit::FitOptions options;
  options.geometry = geometry_of(places);
  return options;
}

inline fit::FitReport fitted(const PoseTable& table, const Places& places) {
  auto report = fit::method_choice::fit(table, options_of(places));
  if (!report) throw std::runtime_error(report.error().text());
  return *std::move(report);
}

inline criticism::search::ExplainReport explained(const PoseTable& table, const Places& places) {
  const criticism::search::ExplainOptions options{
      .fit = options_of(places), .rounds = 3, .candidate_effects = {}};
  auto report = criticism::search::explain(table, options);
  if (!report) throw std::runtime_error(report.error().text());
  return *std::move(report);
}

/// Of all parameters of an array, in their order.
inline Eigen::VectorXd parameter_errors(const calibration::Calibration& c, const rig::RigTruth& truth) {
  Eigen::VectorXd off(c.covariance.rows());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const sensor::SensorModel& s = c.sensors[i];
    const rig::SensorTruth& t = truth[i];
    off.segment<12>(12 * static_cast<Eigen::Index>(i)) << s.theta_rad - to_rad(t.theta_deg),
        s.phi_rad - to_rad(t.phi_deg), s.psi_rad - to_rad(t.psi_deg), s.scale - t.scale,
        s.offset_nT - t.offset_nT, s.alpha_rad - to_rad(t.alpha_deg), s.beta_rad - to_rad(t.beta_deg),
        s.gamma_rad - to_rad(t.gamma_deg);
  }
  return off;
}

/// Errors of all parameters of an array over their covariance (NEES): 12 a sensor on average where it is
/// honest.
inline double squared_error(const calibration::Calibration& c, const rig::RigTruth& truth) {
  const Eigen::VectorXd off = parameter_errors(c, truth);
  return off.dot(c.covariance.ldlt().solve(off));
}

/// Errors of the nine parameters of one sensor that need no frame, over their covariance.
inline double nine_squared_errors(const calibration::Calibration& c, const rig::SensorTruth& truth) {
  const sensor::SensorModel& s = c.sensors[0];
  Eigen::Matrix<double, 9, 1> off;
  off << s.theta_rad - to_rad(truth.theta_deg), s.phi_rad - to_rad(truth.phi_deg),
      s.psi_rad - to_rad(truth.psi_deg), s.scale - truth.scale, s.offset_nT - truth.offset_nT;
  const Eigen::Matrix<double, 9, 9> C = c.covariance.topLeftCorner<9, 9>();
  return off.dot(C.ldlt().solve(off));
}

/// Five standard deviations of the mean of `runs` chi-squares.
inline double band(double unknowns, double runs) { return 5 * std::sqrt(2 * unknowns / runs); }

}  // namespace mgtd::calib::testing
