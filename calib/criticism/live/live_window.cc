// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/live/live_window.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "calib/calibration/field_derivative.h"
#include "calib/calibration/tensor.h"
#include "calib/effects/effect_context.h"
#include "calib/linear/propagation.h"

namespace mgtd::calib::criticism::live {
namespace {

constexpr int kEmptyParts = 2;  // that a block may have

/// dW/dp: closure at the four unit values of q, which it is linear in.
Eigen::MatrixXd closure_by_parameters(const calibration::Calibration& c) {
  const Eigen::MatrixXd rows = calibration::closure_rows(c.geometry);
  const Eigen::Index parameters = c.covariance.cols(), numbers = rows.rows();
  const auto at = [&](const Eigen::Vector3d& b_P_nT) {
    Eigen::MatrixXd d = Eigen::MatrixXd::Zero(c.geometry.channels(), parameters);
    for (std::size_t i = 0; i < c.sensors.size(); ++i) {
      const auto at_sensor = static_cast<Eigen::Index>(i);
      d.block<3, sensor::kSensorParameters>(3 * at_sensor, sensor::kSensorParameters * at_sensor) =
          calibration::field_derivative(c.sensors[i], b_P_nT);
    }
    return Eigen::MatrixXd(rows * d);
  };
  const Eigen::MatrixXd constant = at(Eigen::Vector3d::Zero());
  Eigen::MatrixXd out(4 * numbers, parameters);
  out.topRows(numbers) = constant;
  for (int a = 0; a < 3; ++a)
    out.middleRows(numbers * (1 + a), numbers) =
        at(effects::kReferenceField_nT * Eigen::Vector3d::Unit(a)) - constant;
  return out;
}

}  // namespace

ClosurePrior closure_prior(const calibration::Calibration& c) {
  const auto W = closure_by_parameters(c);
  const auto rows = calibration::closure_rows(c.geometry);
  return {
      linear::propagated_covariance(
          rows,
          calibration::TensorPipeline(std::make_shared<const calibration::Calibration>(c)).sample_noise()),
      linear::propagated_covariance(W, c.covariance), c.geometry.cross_baseline_m().has_value()};
}

LiveWindow::LiveWindow(double block_s, std::size_t blocks, const ClosurePrior& prior)
    : block_s_(block_s), most_(blocks), weight_(prior.sample_noise.inverse()) {
  parts_.fill(nothing());
}

LiveWindow::Sums LiveWindow::nothing() const {
  Sums out;
  out.closure.setZero(weight_.rows());
  return out;
}

bool LiveWindow::add(const ClosureSample& s) {
  const double at = s.t_s / block_s_;
  const auto number = static_cast<std::int64_t>(std::floor(at));
  bool closed = false;
  if (begun_ && number != number_) {
    closed = close();
    parts_.fill(nothing());
  }
  begun_ = true;
  number_ = number;
  const auto part = static_cast<std::size_t>((at - std::floor(at)) * kParts);
  Sums& sums = parts_[std::min<std::size_t>(part, kParts - 1)];
  ++sums.n;
  sums.t_s += s.t_s;
  sums.closure += s.closure;
  sums.u += s.b_P_nT / effects::kReferenceField_nT;
  if (std::isfinite(s.T_degC)) {
    sums.T_degC += s.T_degC;
    ++sums.n_T;
  }
  return closed;
}

bool LiveWindow::close() {
  Sums all = nothing();
  int parts = 0;
  for (const Sums& p : parts_) {
    if (p.n == 0) continue;
    ++parts;
    all.n += p.n;
    all.t_s += p.t_s;
    all.closure += p.closure;
    all.u += p.u;
    all.T_degC += p.T_degC;
    all.n_T += p.n_T;
  }
  if (parts < kParts - kEmptyParts) return false;
  ClosureBlock block{all.t_s / all.n,
                     all.n,
                     all.closure / all.n,
                     all.u / all.n,
                     all.n_T > 0 ? all.T_degC / all.n_T : std::numeric_limits<double>::quiet_NaN(),
                     0};
  for (const Sums& p : parts_) {
    if (p.n == 0) continue;
    const sensor::FieldVector off = p.closure / p.n - block.closure;
    block.excess += p.n * off.dot(weight_ * off) / (static_cast<double>(off.size()) * (parts - 1));
  }
  if (blocks_.size() == most_) blocks_.pop_front();
  blocks_.push_back(block);
  return true;
}

}  // namespace mgtd::calib::criticism::live
