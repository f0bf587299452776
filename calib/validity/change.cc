// SPDX-License-Identifier: Apache-2.0
#include "calib/validity/change.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "calib/fit/orientation.h"
#include "calib/linear/qr.h"
#include "calib/linear/symmetric_eigen.h"
#include "calib/sensor/sensor_equations.h"
#include "calib/sensor/shown_parameters.h"
#include "calib/stats/chi_square.h"

namespace mgtd::calib::validity {
namespace {

/// Correlation eigenvalues below this are a direction both sides fixed by convention.
constexpr double kSingular = 1e-9;
/// Share of a parameter's evidence that must be its own before it is distinct from those already named.
constexpr double kOwnEvidence = 1e-4;
constexpr std::size_t kMaxNamed = 8;
constexpr double kPower80 = 0.8416212;  ///< upper 20 % point of the normal distribution

/// Weight of a difference with the common freedoms projected out: N (N' C N)^-1 N', N orthogonal to them.
Inverse weight_of(const Evidence& e) {
  const Eigen::VectorXd sd = e.covariance.diagonal().cwiseMax(0).cwiseSqrt();
  const Eigen::VectorXd scale = (sd.array() > 0).select(sd.cwiseInverse(), 1.0);
  Eigen::MatrixXd N = scale.asDiagonal();
  if (e.common.cols() > 0) {
    N *= linear::complement_of(scale.asDiagonal() * e.common);
  }
  const Inverse inner = inverse_of(N.transpose() * e.covariance * N);
  return {N * inner.W * N.transpose(), inner.rank};
}

/// W with the columns X fitted and taken out.
Eigen::MatrixXd without(const Eigen::MatrixXd& W, const Eigen::MatrixXd& X) {
  if (X.cols() == 0) return W;
  const Eigen::MatrixXd WX = W * X;
  return W - WX * inverse_of(X.transpose() * WX).W * WX.transpose();
}

/// Whether a change of this parameter can be told at all: the turn of a sensor that is alone is one of the
/// common freedoms.
bool can_be_told(const Evidence& e, Eigen::Index j) {
  return e.sensors > 1 || j < sensor::alpha || j > sensor::gamma;
}

/// Chi-square of the change of one parameter alone; 0 when it is collinear with what was taken out of W.
Eigen::VectorXd single_chi2(const Evidence& e, const Eigen::MatrixXd& W, const Eigen::MatrixXd& M) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(e.gain.cols());
  const Eigen::VectorXd pull = e.gain.transpose() * (M * e.difference);
  for (Eigen::Index j = 0; j < out.size(); ++j) {
    if (!can_be_told(e, j)) continue;
    const auto a = e.gain.col(j);
    const double own = a.dot(M * a);
    if (own > kOwnEvidence * a.dot(W * a)) out[j] = pull[j] * pull[j] / own;
  }
  return out;
}

double corrected_log10_p(double chi2, Eigen::Index choices) {
  return std::min(0.0, stats::chi_square_log10_p(chi2, 1) + std::log10(static_cast<double>(choices)));
}

/// One parameter after the other, as long as the next is beyond chance.
std::vector<Eigen::Index> account_for(const Evidence& e, const Eigen::MatrixXd& W) {
  std::vector<Eigen::Index> chosen;
  Eigen::MatrixXd X(e.difference.size(), 0);
  while (chosen.size() < kMaxNamed) {
    Eigen::Index best = 0;
    const double chi2 = single_chi2(e, W, without(W, X)).maxCoeff(&best);
    if (corrected_log10_p(chi2, e.gain.cols()) > std::log10(kChanged / 2)) break;
    chosen.push_back(best);
    X.conservativeResize(Eigen::NoChange, X.cols() + 1);
    X.rightCols<1>() = e.gain.col(best);
  }
  return chosen;
}

ParameterChange shown(const ShownSlot& slot, double change, double sd, Eigen::Index choices) {
  const double sigmas = std::isfinite(sd) && sd > 0 ? change / sd : 0;
  return {.name = slot.name,
          .change = change * slot.factor,
          .sd = sd * slot.factor,
          .unit = slot.unit,
          .sigmas = sigmas,
          .log10_p = corrected_log10_p(sigmas * sigmas, choices)};
}

std::vector<ParameterChange> named_changes(const Evidence& e, const Eigen::MatrixXd& W) {
  const std::vector<Eigen::Index> chosen = account_for(e, W);
  if (chosen.empty()) return {};
  const Eigen::MatrixXd A = e.gain(Eigen::all, chosen);
  const Eigen::MatrixXd C = inverse_of(A.transpose() * W * A).W;
  const Eigen::VectorXd x = C * (A.transpose() * (W * e.difference));
  std::vector<ParameterChange> out;
  for (std::size_t n = 0; n < chosen.size(); ++n) {
    const auto at = static_cast<Eigen::Index>(n);
    out.push_back(
        shown(e.slots[static_cast<std::size_t>(chosen[n])], x[at], std::sqrt(C(at, at)), e.gain.cols()));
  }
  return out;
}

/// The difference with the common freedoms fitted and taken out, and its covariance.
std::pair<Eigen::VectorXd, Eigen::MatrixXd> without_common(const Evidence& e) {
  if (e.common.cols() == 0) return {e.difference, e.covariance};
  const CommonPart common = common_part(e);
  return {e.difference - e.common * common.size,
          e.covariance - e.common * common.covariance * e.common.transpose()};
}

/// What is left when one sensor may have changed in any way.
double others_log10_p(const Evidence& e, const Eigen::MatrixXd& W, Eigen::Index rank, int sensor) {
  const Eigen::MatrixXd A = e.gain.middleCols<sensor::kSensorParameters>(sensor::kSensorParameters * sensor);
  const Inverse spread = inverse_of(A.transpose() * W * A);
  const Eigen::VectorXd pull = A.transpose() * (W * e.difference);
  return stats::chi_square_log10_p(e.difference.dot(W * e.difference) - pull.dot(spread.W * pull),
                                   static_cast<double>(rank - spread.rank));
}

}  // namespace

Inverse inverse_of(const Eigen::MatrixXd& C) {
  const Eigen::VectorXd sd = C.diagonal().cwiseMax(0).cwiseSqrt();
  const Eigen::VectorXd scale = (sd.array() > 0).select(sd.cwiseInverse(), 0.0);
  const linear::SymmetricEigen eigen = linear::symmetric_eigen(scale.asDiagonal() * C * scale.asDiagonal());
  Eigen::VectorXd inverse = Eigen::VectorXd::Zero(C.rows());
  Inverse out;
  for (Eigen::Index j = 0; j < C.rows(); ++j) {
    if (eigen.values[j] < kSingular) continue;
    inverse[j] = 1 / eigen.values[j];
    ++out.rank;
  }
  const Eigen::MatrixXd V = scale.asDiagonal() * eigen.vectors;
  out.W = V * inverse.asDiagonal() * V.transpose();
  return out;
}

double Change::p() const { return std::min(1.0, 2 * std::pow(10.0, std::min(log10_p, log10_p_single))); }

std::vector<ShownSlot> shown_slots(std::size_t sensors,
                                   const std::vector<calibration::CalibratedEffect>& effects) {
  std::vector<ShownSlot> out;
  for (std::size_t i = 1; i <= sensors; ++i) {
    for (const sensor::ShownParameter& p : sensor::shown_parameters())
      out.push_back({fmt::format("s{} {}", i, p.name), p.unit, p.factor});
  }
  for (const calibration::CalibratedEffect& effect : effects) {
    for (const calibration::EffectCoefficient& c : effect.coefficients)
      out.push_back({fmt::format("{} {}", effect.effect, c.name), c.unit, 1});
  }
  return out;
}

double small_sample_factor(int poses, std::size_t sensors) {
  // Three readings of a sensor a pose, less the three of its field that all sensors share, or the two of its
  // direction where one sensor is alone; less the four that each axis fits.
  const double share = sensors > 1 ? 1 - 1 / static_cast<double>(sensors) : 1.0 / 3;
  const double freedom = share * poses - 4;
  return freedom > 4 ? freedom / (freedom - 2) : 2;
}

TurnedArray turned(const PerSensor<sensor::SensorModel>& sensors, const Eigen::Matrix3d& Q) {
  constexpr double h = 1e-6;  // angles, in which alone the turn is not linear
  const Eigen::Index slots = static_cast<Eigen::Index>(sensors.size()) * sensor::kSensorParameters;
  TurnedArray out{.sensors = sensors, .jacobian = Eigen::MatrixXd::Identity(slots, slots)};
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    out.sensors[i] = fit::turned(sensors[i], Q);
    const auto at = static_cast<Eigen::Index>(i) * sensor::kSensorParameters;
    for (const int p : {sensor::alpha, sensor::beta, sensor::gamma}) {
      sensor::ParameterVector up = sensors[i].parameters(), down = up;
      up[p] += h;
      down[p] -= h;
      const auto moved = [&](const sensor::ParameterVector& x) {
        return fit::turned(sensor::SensorModel::from_parameters(x, sensors[i].mounting), Q).parameters();
      };
      out.jacobian.block<3, 1>(at + sensor::alpha, at + p) = (moved(up) - moved(down)).tail<3>() / (2 * h);
    }
  }
  return out;
}

Eigen::MatrixXd common_freedoms(const PerSensor<sensor::SensorModel>& sensors, Eigen::Index slots,
                                bool free_scale) {
  constexpr double h = 1e-6;
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(slots, free_scale ? 4 : 3);
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i) * sensor::kSensorParameters;
    for (int j = 0; j < 3; ++j) {
      const Eigen::Vector3d w = h * Eigen::Vector3d::Unit(j);
      const sensor::ParameterVector up = fit::turned(sensors[i], sensor::turn_by<double>(w)).parameters();
      const sensor::ParameterVector down = fit::turned(sensors[i], sensor::turn_by<double>(-w)).parameters();
      out.block<3, 1>(at + sensor::alpha, j) = (up - down).tail<3>() / (2 * h);
    }
    if (free_scale) out.block<3, 1>(at + sensor::cx, 3) = sensors[i].scale;
  }
  return out;
}

CommonTurn common_turn(const Eigen::Matrix3d& Q, const Eigen::Vector3d& sd_rad) {
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(Q.transpose()));  // the angles of the sensors are passive
  return {turn.angle() * turn.axis(), sd_rad};
}

CommonPart common_part(const Evidence& e) {
  const Eigen::MatrixXd WX = inverse_of(e.covariance).W * e.common;
  const Eigen::MatrixXd C = inverse_of(e.common.transpose() * WX).W;
  return {C * (WX.transpose() * e.difference), C};
}

Change judge(const Evidence& e) {
  const auto [W, rank] = weight_of(e);
  const Eigen::Index choices = e.gain.cols();
  Change out;
  out.chi2 = e.difference.dot(W * e.difference);
  out.dof = static_cast<double>(rank);
  out.log10_p = stats::chi_square_log10_p(out.chi2, out.dof);
  out.log10_p_single = corrected_log10_p(single_chi2(e, W, W).maxCoeff(), choices);
  out.named = named_changes(e, W);
  out.others_log10_p.resize(e.sensors);
  for (std::size_t i = 0; i < e.sensors; ++i)
    out.others_log10_p[i] = others_log10_p(e, W, rank, static_cast<int>(i));
  const double limit = std::sqrt(stats::chi_square_limit(kChanged / 2 / static_cast<double>(choices), 1));
  // Only where each parameter has a row of its own is there a difference of it.
  const bool own_rows = e.gain.rows() == choices && e.gain.isIdentity();
  const auto [moved, C] = own_rows ? without_common(e) : std::pair<Eigen::VectorXd, Eigen::MatrixXd>{};
  for (Eigen::Index j = 0; j < choices; ++j) {
    if (!can_be_told(e, j)) continue;
    const auto a = e.gain.col(j);
    const double information = a.dot(W * a), sd = 1 / std::sqrt(information);
    const ShownSlot& slot = e.slots[static_cast<std::size_t>(j)];
    out.parameters.push_back(shown(slot, a.dot(W * e.difference) / information, sd, choices));
    out.parameters.back().seen = (limit + kPower80) * sd * slot.factor;
    if (!own_rows) continue;
    out.parameters.back().moved = moved[j] * slot.factor;
    out.parameters.back().moved_sd = std::sqrt(std::max(0.0, C(j, j))) * slot.factor;
  }
  std::stable_sort(out.parameters.begin(), out.parameters.end(),
                   [](const auto& a, const auto& b) { return std::abs(a.sigmas) > std::abs(b.sigmas); });
  return out;
}

}  // namespace mgtd::calib::validity
