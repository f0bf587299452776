// SPDX-License-Identifier: Apache-2.0
#include "tests/blind/real_answer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <ctime>
#include <random>

#include "calib/criticism/search/stand_ins.h"
#include "calib/discovery/remaining_law.h"
#include "calib/fit/method_choice/fit.h"
#include "calib/fit/orientation.h"
#include "proto/units.h"

namespace mgtd::calib::testing {
namespace {

using Sensors = PerSensor<sensor::SensorModel>;
constexpr double kField_nT = 50'000, kBaseline_m = 0.4;
constexpr double kAsGood = 1.2;  ///< times the plain rig's error

bool holds(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Fields of one strength uniformly over the sphere, always the same.
std::vector<Eigen::Vector3d> fields() {
  constexpr int kCount = 300;
  std::mt19937_64 random(4242);
  std::normal_distribution<double> normal;
  std::vector<Eigen::Vector3d> out;
  for (int k = 0; k < kCount; ++k) {
    const double z = normal(random), y = normal(random), x = normal(random);
    out.push_back(kField_nT * Eigen::Vector3d(x, y, z).normalized());
  }
  return out;
}

double tensor_error(const Sensors& estimate, const rig::RigTruth& truth) {
  static const std::vector<Eigen::Vector3d> kFields = fields();
  double sum = 0;
  for (const Eigen::Vector3d& field : kFields) {
    std::array<Eigen::Vector3d, 4> b;
    for (std::size_t i = 0; i < b.size(); ++i)
      b[i] = estimate[i].correct(truth[i].matrix() * field + truth[i].offset_nT);
    const Eigen::Vector3d x = (b[0] - b[2]) / kBaseline_m, y = (b[1] - b[3]) / kBaseline_m;
    const double xy = (x[1] + y[0]) / 2, zz = x[0] + y[1];
    sum += (x[0] * x[0] + y[1] * y[1] + zz * zz + xy * xy + x[2] * x[2] + y[2] * y[2]) / 6;
  }
  return std::sqrt(sum / static_cast<double>(kFields.size()));
}

sensor::ParameterVector parameters_of(const rig::SensorTruth& t) {
  sensor::ParameterVector out;
  out << to_rad(t.theta_deg), to_rad(t.phi_deg), to_rad(t.psi_deg), t.scale, t.offset_nT, to_rad(t.alpha_deg),
      to_rad(t.beta_deg), to_rad(t.gamma_deg);
  return out;
}

/// The rotation that takes the true platform frame nearest to the estimated one.
Eigen::Matrix3d common_turn(const Sensors& estimate, const rig::RigTruth& truth) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < estimate.size(); ++i)
    sum +=
        estimate[i].R_PS() * sensor::SensorModel::from_parameters(parameters_of(truth[i])).R_PS().transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * svd.matrixV().transpose();
}

/// A coarse table leaves the common rotation of all sensors uncertain by a quarter degree, and the angles
/// follow it along a curve that is far from straight beside what is known of them against each other. So the
/// common rotation is taken out exactly, and its own normalised square added.
double nees_of_scales(const calibration::Calibration& calibration, const rig::RigTruth& truth,
                      const std::vector<Eigen::Index>& which) {
  const Eigen::Matrix3d R = common_turn(calibration.sensors, truth);
  const auto parameters = [&](const Eigen::Matrix3d& turn) {
    Eigen::VectorXd all(calibration::kArrayParameters);
    for (int i = 0; i < kSensors; ++i)
      all.segment<sensor::kSensorParameters>(i * sensor::kSensorParameters) =
          fit::turned(sensor::SensorModel::from_parameters(parameters_of(truth[static_cast<std::size_t>(i)])),
                      turn)
              .parameters();
    return Eigen::VectorXd(all(which));
  };
  const Eigen::VectorXd at = parameters(R);
  Eigen::MatrixXd J(at.size(), 3);
  constexpr double kStep = 1e-6;
  for (int a = 0; a < 3; ++a)
    J.col(a) = (parameters(Eigen::AngleAxisd(kStep, Eigen::Vector3d::Unit(a)) * R) - at) / kStep;
  Eigen::VectorXd estimate(calibration::kArrayParameters);
  for (int i = 0; i < kSensors; ++i)
    estimate.segment<sensor::kSensorParameters>(i * sensor::kSensorParameters) =
        calibration.sensors[static_cast<std::size_t>(i)].parameters();
  const Eigen::LDLT<Eigen::MatrixXd> C(calibration.covariance(which, which));
  const Eigen::VectorXd d = estimate(which) - at;
  const Eigen::Matrix3d information = J.transpose() * C.solve(J);
  const Eigen::Vector3d further = information.ldlt().solve(J.transpose() * C.solve(d));
  const Eigen::VectorXd left = d - J * further;
  const Eigen::AngleAxisd turn(R);
  const Eigen::Vector3d rotation = turn.angle() * turn.axis() + further;
  return left.dot(C.solve(left)) + rotation.dot(information * rotation);
}

void judge_covariance(const calibration::Calibration& calibration, const rig::RigTruth& truth,
                      RealAnswer& out) {
  Eigen::VectorXd error(calibration::kArrayParameters);
  std::vector<Eigen::Index> scales, offsets;
  for (int i = 0; i < kSensors; ++i) {
    const auto s = static_cast<std::size_t>(i);
    error.segment<sensor::kSensorParameters>(i * sensor::kSensorParameters) =
        calibration.sensors[s].parameters() - parameters_of(truth[s]);
    for (int p = 0; p < sensor::kSensorParameters; ++p)
      (p >= sensor::ix && p <= sensor::iz ? offsets : scales).push_back(i * sensor::kSensorParameters + p);
  }
  const Eigen::VectorXd e = error(offsets);
  out.nees_offsets = e.dot(calibration.covariance(offsets, offsets).ldlt().solve(e));
  out.nees_scales = nees_of_scales(calibration, truth, scales);
}

void read(const criticism::search::ExplainReport& report, const rig::RigTruth& truth, RealAnswer& out) {
  out.finding = report.finding;
  out.left_out = !report.outliers.empty();
  out.named = out.declared = report.named;
  for (const criticism::search::Round& round : report.rounds)
    out.declared.insert(out.declared.end(), round.possible.begin(), round.possible.end());
  if (!report.rounds.empty() && report.rounds.back().fit)
    out.error_after_nT_per_m = tensor_error(report.rounds.back().fit->state.sensors, truth);
}

bool right_names(const RealAnswer& a, const RealKind& kind) {
  if (a.finding != criticism::search::Finding::explained &&
      a.finding != criticism::search::Finding::ambiguous)
    return false;
  if (a.finding == criticism::search::Finding::explained && a.wrong_name(kind)) return false;
  // Several laws at once: each of them. Several names of one thing: one of them.
  const auto found = [&](const std::string& name) { return holds(a.declared, name); };
  return kind.name == "two-laws" ? std::all_of(kind.right.begin(), kind.right.end(), found)
                                 : std::any_of(kind.right.begin(), kind.right.end(), found);
}

/// Processor time; a part of a campaign does all its work on its own thread.
double of_this_thread_s() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

bool RealAnswer::wrong_name(const RealKind& kind) const {
  return std::any_of(named.begin(), named.end(), [&](const auto& name) { return !holds(kind.right, name); });
}

bool RealAnswer::wrong_single(const RealKind& kind) const {
  return finding == criticism::search::Finding::explained && named.size() == 1 && wrong_name(kind);
}

bool RealAnswer::good(const RealKind& kind) const {
  const bool said = !fit_refused && !explain_refused;
  switch (kind.must) {
    case Must::pass:
      return said && accepted && finding == criticism::search::Finding::pass && named.empty();
    case Must::no_name:
      return said && accepted && named.empty();
    case Must::name:
      return said && right_names(*this, kind);
    case Must::open:
      return said && finding != criticism::search::Finding::pass && !wrong_name(kind);
    case Must::set_aside:
      return said && accepted && !wrong_name(kind) && over_plain() <= kAsGood;
    case Must::refuse:
      return !accepted && (explain_refused || finding == criticism::search::Finding::bad_data);
    case Must::agree:
      return said && accepted == (finding == criticism::search::Finding::pass) && named.empty();
  }
  return false;
}

RealAnswer answer_to(const RealRun& run, bool parameters) {
  RealAnswer out;
  const double begin_s = of_this_thread_s();
  const auto fitted = fit::method_choice::fit(run.table, {});
  auto explained = criticism::search::explain(run.table, {});
  if (explained && explained->finding == criticism::search::Finding::partial)
    if (const auto law = discovery::law_instead(run.table, {.fit = {}, .checks = false}, explained->model))
      criticism::search::take_back_stand_ins(law->instead_of, *explained);
  out.cpu_s = of_this_thread_s() - begin_s;
  out.fit_refused = !fitted;
  out.explain_refused = !explained;
  if (fitted) {
    const calibration::Calibration& calibration = fitted->calibration;
    out.accepted = calibration.accepted_by_checks;
    out.error_nT_per_m = out.error_after_nT_per_m = tensor_error(calibration.sensors, run.truth);
    if (parameters) judge_covariance(calibration, run.truth, out);
  }
  if (explained) read(*explained, run.truth, out);
  if (const auto plain = fit::joint::fit_joint(run.plain, {}))
    out.plain_nT_per_m = tensor_error(plain->state.sensors, run.plain_truth);
  return out;
}

std::string told(const RealAnswer& a) {
  std::string out = a.explain_refused ? "explain refuses" : std::string(to_string(a.finding));
  out += fmt::format(" {}", fmt::join(a.named, " "));
  if (a.fit_refused) return out + ", fit refuses";
  if (!a.accepted) out += ", not accepted";
  if (a.error_nT_per_m)
    out += fmt::format(", {:.3f} nT/m, after explain {:.3f}", *a.error_nT_per_m, *a.error_after_nT_per_m);
  if (a.plain_nT_per_m) out += fmt::format(", plain {:.3f}", *a.plain_nT_per_m);
  return out;
}

}  // namespace mgtd::calib::testing
