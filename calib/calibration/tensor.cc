// SPDX-License-Identifier: Apache-2.0
#include "calib/calibration/tensor.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "calib/calibration/effect_correction.h"
#include "calib/calibration/field_derivative.h"
#include "calib/calibration/field_expansion.h"
#include "calib/linear/cholesky4.h"
#include "calib/linear/propagation.h"

namespace mgtd::calib::calibration {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

using ClosureCovariance = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor,
                                        sensor::kMostChannels, sensor::kMostChannels>;

double closure_chi2(const Closure& closure, const Eigen::Matrix4d& covariance) {
  Eigen::Vector4d values;
  values << closure.curl_nT_per_m, closure.center_nT;
  return linear::Cholesky4(covariance).whitened(values).squaredNorm();
}

double closure_chi2(const Closure& closure, const ClosureCovariance& covariance) {
  if (closure.dof == 0) return kNaN;
  if (closure.combinations_nT.size() == 0) return closure_chi2(closure, Eigen::Matrix4d(covariance));
  const sensor::FieldVector& values = closure.combinations_nT;
  return covariance.llt().matrixL().solve(values).squaredNorm();
}

/// S becomes symmetric: `at(pair)` gives the pairs of its upper triangle, row by row.
void fill_symmetric(auto& S, const auto& at) {
  std::size_t pair = 0;
  for (Eigen::Index i = 0; i < S.rows(); ++i)
    for (Eigen::Index j = i; j < S.cols(); ++j) S(i, j) = S(j, i) = at(pair++);
}

FieldExpansion expansion_of(const sensor::Geometry& geometry) {
  const auto& places = geometry.positions_P_m();
  return FieldExpansion::of({places.data(), places.size()}).value();
}

/// What a live sample knows of its circumstances.
Pose pose_of(const Epoch& epoch) {
  Pose pose;
  pose.y_nT = epoch.y_nT;
  pose.t_utc = epoch.t.wall;
  pose.T_degC.resize(epoch.T_degC.size());
  for (std::size_t i = 0; i < epoch.T_degC.size(); ++i) {
    if (std::isfinite(epoch.T_degC[i])) pose.T_degC[i] = epoch.T_degC[i];
  }
  return pose;
}

}  // namespace

double root_mean_square(const Gradient& g) {
  double sum = 0, count = 0;
  for (const double x : components(g)) {
    if (std::isnan(x)) continue;
    sum += x * x;
    ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : kNaN;
}

sensor::FieldVector closure_numbers(const Closure& closure) {
  if (std::isnan(closure.curl_nT_per_m)) return closure.combinations_nT;
  return Eigen::Vector4d(closure.curl_nT_per_m, closure.center_nT[0], closure.center_nT[1],
                         closure.center_nT[2]);
}

sensor::FieldVector stacked(const PerSensor<Eigen::Vector3d>& b) {
  sensor::FieldVector out(3 * static_cast<Eigen::Index>(b.size()));
  for (std::size_t i = 0; i < b.size(); ++i) out.segment<3>(3 * static_cast<Eigen::Index>(i)) = b[i];
  return out;
}

sensor::ChannelColumns<6> gradient_rows(const sensor::Geometry& geometry) {
  const auto baseline_m = geometry.cross_baseline_m();
  if (!baseline_m) {
    const FieldExpansion expansion = expansion_of(geometry);
    sensor::ChannelColumns<6> rows = expansion.gradient_rows();
    for (Eigen::Index i = 0; i < 6; ++i)
      if (!expansion.determined()[static_cast<std::size_t>(i)]) rows.row(i).setConstant(kNaN);
    return rows;
  }
  const double g = 1 / *baseline_m;
  sensor::ChannelColumns<6> m = sensor::ChannelColumns<6>::Zero(6, sensor::kChannels);
  const auto difference = [&](int row, int axis, int plus, int minus, double weight) {
    m(row, 3 * plus + axis) += weight;
    m(row, 3 * minus + axis) -= weight;
  };
  difference(0, 0, 0, 2, g);  // Bxx
  difference(1, 1, 1, 3, g);  // Byy
  m.row(2) = -m.row(0) - m.row(1);
  difference(3, 0, 1, 3, g / 2);  // Bxy
  difference(3, 1, 0, 2, g / 2);  // Byx
  difference(4, 2, 0, 2, g);      // Bzx
  difference(5, 2, 1, 3, g);      // Bzy
  return m;
}

Eigen::MatrixXd closure_rows(const sensor::Geometry& geometry) {
  const auto baseline_m = geometry.cross_baseline_m();
  if (!baseline_m) return expansion_of(geometry).closure_rows();
  const double g = 1 / *baseline_m;
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(4, sensor::kChannels);
  m(0, 3 * 1) = g, m(0, 3 * 3) = -g;  // Bxy
  m(0, 1) = -g, m(0, 3 * 2 + 1) = g;  // -Byx
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < kSensors; ++i) m(1 + axis, 3 * i + axis) = i % 2 == 0 ? 0.5 : -0.5;
  }
  return m;
}

FieldAndGradient field_and_gradient(const sensor::FieldVector& b, double baseline_m) {
  const auto b1 = b.segment<3>(0), b2 = b.segment<3>(3), b3 = b.segment<3>(6), b4 = b.segment<3>(9);
  const double d = baseline_m;
  const Eigen::Vector3d along_x = (b1 - b3) / d, along_y = (b2 - b4) / d;
  FieldAndGradient out;
  out.b_P_nT = (b1 + b2 + b3 + b4) / 4;
  out.g_nT_per_m = {.xx = along_x[0],
                    .yy = along_y[1],
                    .zz = -(along_x[0] + along_y[1]),
                    .xy = (along_y[0] + along_x[1]) / 2,
                    .xz = along_x[2],
                    .yz = along_y[2]};
  out.closure.curl_nT_per_m = along_y[0] - along_x[1];
  out.closure.center_nT = (b1 + b3 - b2 - b4) / 2;
  out.closure.chi2 = kNaN;
  return out;
}

/// What takes the corrected components of an array that is not the cross to field, gradient and closure.
struct TensorPipeline::Rows {
  sensor::ChannelColumns<3> field;
  sensor::ChannelColumns<6> gradient;
  sensor::ChannelColumns<3> along_line;  ///< without columns where the sensors stand on no line
  ClosureCovariance closure;

  [[nodiscard]] static std::shared_ptr<const Rows> of(const sensor::Geometry& geometry) {
    if (geometry.cross_baseline_m()) return nullptr;
    const FieldExpansion expansion = expansion_of(geometry);
    const auto& along = expansion.derivatives_along();
    return std::make_shared<const Rows>(Rows{
        expansion.field_rows(), gradient_rows(geometry),
        along.size() == 1 ? sensor::ChannelColumns<3>(along.front().rows) : sensor::ChannelColumns<3>(3, 0),
        expansion.closure_rows()});
  }
};

int TensorPipeline::closure_dof() const {
  return rows_ ? static_cast<int>(rows_->closure.rows()) : Closure().dof;
}

FieldAndGradient TensorPipeline::expanded(const sensor::FieldVector& b) const {
  if (!rows_) return field_and_gradient(b, baseline_m_);
  FieldAndGradient out;
  out.b_P_nT = rows_->field.lazyProduct(b);
  const Eigen::Matrix<double, 6, 1> g = rows_->gradient.lazyProduct(b);
  out.g_nT_per_m = {.xx = g[0], .yy = g[1], .zz = g[2], .xy = g[3], .xz = g[4], .yz = g[5]};
  if (rows_->along_line.cols() > 0) out.along_line_nT_per_m = rows_->along_line.lazyProduct(b);
  out.closure.curl_nT_per_m = kNaN;
  out.closure.center_nT.setConstant(kNaN);
  out.closure.combinations_nT = rows_->closure.lazyProduct(b);
  out.closure.chi2 = kNaN;
  out.closure.dof = static_cast<int>(rows_->closure.rows());
  return out;
}

TensorPipeline::TensorPipeline(const sensor::Geometry& geometry)
    : geometry_(geometry),
      baseline_m_(geometry.cross_baseline_m().value_or(0)),
      rows_(Rows::of(geometry)),
      gain_(geometry.sensors(), Eigen::Matrix3d::Identity()),
      offset_nT_(geometry.sensors(), Eigen::Vector3d::Zero()) {}

TensorPipeline::TensorPipeline(std::shared_ptr<const Calibration> calibration, const PoseTable* run)
    : calibration_(std::move(calibration)),
      id_(std::shared_ptr<const std::string>(calibration_, &calibration_->id)),
      geometry_(calibration_->geometry),
      baseline_m_(geometry_.cross_baseline_m().value_or(0)),
      rows_(Rows::of(geometry_)),
      gain_(0),
      offset_nT_(0) {
  for (const sensor::SensorModel& sensor : calibration_->sensors) {
    gain_.push_back(sensor.R_PS() * sensor.response().inverse());
    offset_nT_.push_back(sensor.offset_nT);
  }
  if (!calibration_->effects.empty()) effects_ = std::make_shared<const EffectCorrection>(*calibration_, run);
  noise_known_ = (calibration_->sample_noise_nT.array() > 0).all();
  prepare_uncertainty();
}

void TensorPipeline::prepare_uncertainty() {
  // The derivative of the corrected fields is linear in q = (1, b): evaluate it at the four unit values of q.
  using ParameterRows = Eigen::Matrix<double, 4, Eigen::Dynamic>;  // rows: q components
  using Weights = sensor::ChannelColumns<1>;
  const auto rows_of = [&](const Weights& w) {
    ParameterRows rows(4, calibration_->covariance.cols());
    for (std::size_t i = 0; i < gain_.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      const auto weight = w.segment<3>(3 * at);
      const auto constant =
          (weight * field_derivative(calibration_->sensors[i], Eigen::Vector3d::Zero())).eval();
      rows.block<1, sensor::kSensorParameters>(0, at * sensor::kSensorParameters) = constant;
      for (int a = 0; a < 3; ++a) {
        rows.block<1, sensor::kSensorParameters>(1 + a, at * sensor::kSensorParameters) =
            weight * field_derivative(calibration_->sensors[i], Eigen::Vector3d::Unit(a)) - constant;
      }
    }
    return rows;
  };
  const auto corrected = [&](const AxisNoise& of_reading_nT) {
    const Eigen::Index channels = geometry_.channels();
    sensor::ChannelCovariance out = sensor::ChannelCovariance::Zero(channels, channels);
    for (std::size_t i = 0; i < gain_.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      out.block<3, 3>(3 * at, 3 * at) =
          gain_[i] * of_reading_nT.row(at).array().square().matrix().asDiagonal() * gain_[i].transpose();
    }
    return out;
  };
  noise_ = corrected(calibration_->sample_noise_nT);
  const sensor::ChannelCovariance scatter = corrected(calibration_->pose_noise_nT);
  const auto covariance = [&](const Weights& u, const Weights& v) {
    const Eigen::Matrix4d Q = rows_of(u) * calibration_->covariance * rows_of(v).transpose();
    const double noise = sensor::over_channels(
        u.size(), [&](auto n) { return u.head(n).dot(noise_.topLeftCorner(n, n) * v.head(n).transpose()); });
    return Variance{noise, 0.5 * (Q + Q.transpose())};
  };
  const auto G = gradient_rows(geometry_);
  const auto uncertainty = [&](const auto& row) {
    return Uncertainty{covariance(row, row), linear::propagated_variance(row.transpose(), scatter)};
  };
  for (Eigen::Index i = 0; i < 6; ++i)
    gradient_uncertainty_[static_cast<std::size_t>(i)] = uncertainty(G.row(i));
  for (Eigen::Index i = 0; rows_ && rows_->along_line.cols() > 0 && i < 3; ++i)
    line_uncertainty_[static_cast<std::size_t>(i)] = uncertainty(rows_->along_line.row(i));
  const auto C = closure_rows(geometry_);
  for (Eigen::Index i = 0; i < C.rows(); ++i) {
    for (Eigen::Index j = i; j < C.rows(); ++j) closure_covariance_.push_back(covariance(C.row(i), C.row(j)));
  }
}

sensor::FieldVector TensorPipeline::correct(const PerSensor<Eigen::Vector3d>& y_nT) const {
  sensor::FieldVector b(geometry_.channels());
  for (std::size_t i = 0; i < gain_.size(); ++i)
    b.segment<3>(3 * static_cast<Eigen::Index>(i)).noalias() = gain_[i] * (y_nT[i] - offset_nT_[i]);
  return b;
}

TensorSample TensorPipeline::sample(const sensor::FieldVector& b_P_nT) const {
  const FieldAndGradient computed = expanded(b_P_nT);
  TensorSample out;
  out.calibration_id = id_;
  out.b_P_nT = computed.b_P_nT;
  out.f_nT = computed.b_P_nT.norm();
  out.g_nT_per_m = computed.g_nT_per_m;
  out.g_sd_nT_per_m = {kNaN, kNaN, kNaN, kNaN, kNaN, kNaN};
  if (computed.along_line_nT_per_m)
    out.along_line = {*computed.along_line_nT_per_m, Eigen::Vector3d::Constant(kNaN)};
  out.closure = computed.closure;
  if (calibration_ == nullptr) out.flags |= Flag::uncalibrated;
  return out;
}

/// By the quadratic forms: parameters and noise only.
void TensorPipeline::add_uncertainty(double samples, TensorSample& out) const {
  Eigen::Vector4d q;
  q << 1, out.b_P_nT;
  std::array<double, 6> sd{};
  for (std::size_t i = 0; i < sd.size(); ++i) sd[i] = gradient_uncertainty_[i].sd(q, samples);
  out.g_sd_nT_per_m = {sd[0], sd[1], sd[2], sd[3], sd[4], sd[5]};
  for (std::size_t i = 0; out.along_line && i < 3; ++i)
    out.along_line->sd_nT_per_m[static_cast<Eigen::Index>(i)] = line_uncertainty_[i].sd(q, samples);
  const auto at = [&](std::size_t pair) { return closure_covariance_[pair].at(q, samples); };
  if (rows_) {
    ClosureCovariance S(out.closure.dof, out.closure.dof);
    fill_symmetric(S, at);
    out.closure.chi2 = closure_chi2(out.closure, S);
  } else {
    Eigen::Matrix4d S;
    fill_symmetric(S, at);
    out.closure.chi2 = closure_chi2(out.closure, S);
  }
}

Gradient TensorPipeline::gradient_sd(const sensor::ChannelCovariance& covariance, double samples) const {
  const auto G = gradient_rows(geometry_);
  std::array<double, 6> sd{};
  for (std::size_t i = 0; i < sd.size(); ++i) {
    const auto row = G.row(static_cast<Eigen::Index>(i));
    sd[i] = std::sqrt(linear::propagated_variance(row.transpose(), covariance) +
                      gradient_uncertainty_[i].noise(samples));
  }
  return {sd[0], sd[1], sd[2], sd[3], sd[4], sd[5]};
}

Eigen::Vector3d TensorPipeline::along_line_sd(const sensor::ChannelCovariance& covariance,
                                              double samples) const {
  Eigen::Vector3d out = Eigen::Vector3d::Constant(kNaN);
  for (Eigen::Index i = 0; rows_ && rows_->along_line.cols() > 0 && i < 3; ++i)
    out[i] = std::sqrt(linear::propagated_variance(rows_->along_line.row(i).transpose(), covariance) +
                       line_uncertainty_[static_cast<std::size_t>(i)].noise(samples));
  return out;
}

void TensorPipeline::add_uncertainty(const sensor::ChannelCovariance& covariance, double samples,
                                     TensorSample& out) const {
  out.g_sd_nT_per_m = gradient_sd(covariance, samples);
  if (out.along_line) out.along_line->sd_nT_per_m = along_line_sd(covariance, samples);
  const auto C = closure_rows(geometry_);
  out.closure.chi2 = closure_chi2(
      out.closure, ClosureCovariance(linear::propagated_covariance(C, covariance + noise_ / samples)));
}

TensorSample TensorPipeline::apply(const Pose& pose, double samples, bool remove_site, const Pose* previous,
                                   sensor::FieldVector* fields_P_nT) const {
  const bool with_effects = effects_ && (remove_site || effects_->has_instrument_effects());
  Corrected corrected;
  if (with_effects) {
    corrected = effects_->correct(pose, stacked(pose.y_nT), remove_site, previous);
  } else {
    corrected.b_P_nT = correct(pose.y_nT);
  }
  if (fields_P_nT != nullptr) *fields_P_nT = corrected.b_P_nT;
  TensorSample out = sample(corrected.b_P_nT);
  if (with_effects && !effects_->left_out(pose, remove_site).empty()) out.flags |= Flag::incomplete;
  if (calibration_ == nullptr || !noise_known_) return out;
  if (with_effects) {
    add_uncertainty(corrected.covariance, samples, out);
  } else {
    add_uncertainty(samples, out);
  }
  return out;
}

TensorSample TensorPipeline::by_parameters(const PerSensor<Eigen::Vector3d>& y_nT, double samples,
                                           sensor::FieldVector* fields_P_nT) const {
  const sensor::FieldVector b_P_nT = correct(y_nT);
  if (fields_P_nT != nullptr) *fields_P_nT = b_P_nT;
  TensorSample out = sample(b_P_nT);
  if (calibration_ != nullptr && noise_known_) add_uncertainty(samples, out);
  return out;
}

TensorSample TensorPipeline::apply(const Epoch& epoch, double samples,
                                   sensor::FieldVector* fields_P_nT) const {
  TensorSample out = effects_ && effects_->has_instrument_effects()
                         ? apply(pose_of(epoch), samples, false, nullptr, fields_P_nT)
                         : by_parameters(epoch.y_nT, samples, fields_P_nT);
  out.seq = epoch.seq;
  out.t = epoch.t;
  out.skew_bound_s = epoch.skew_bound_s;
  out.flags |= epoch.flags;
  return out;
}

}  // namespace mgtd::calib::calibration
