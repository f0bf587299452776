// SPDX-License-Identifier: Apache-2.0
#include "calib/design/hypothesis_fit.h"

#include <fmt/format.h>

#include <algorithm>

#include "calib/criticism/tests/collinearity.h"
#include "calib/criticism/tests/residual.h"
#include "calib/effects/library/library.h"
#include "calib/linear/qr.h"

namespace mgtd::calib::design {
namespace {

namespace tests = criticism::tests;

constexpr double kLeft = 1e-4;       ///< of a signature, in length, that the calibration must leave
constexpr double kContained = 0.02;  ///< of a signature, in length, that another one must lack to be another

/// What of v no combination of columns is.
Eigen::VectorXd beyond_columns(const Eigen::VectorXd& v, const Eigen::MatrixXd& columns) {
  return v - columns * linear::least_squares(columns, v);
}

/// One effect with the number that fits best where its formula leaves one open.
Result<std::string> without_open_number(const std::string& text, const ModelOnPoses& model,
                                        const tests::Residual& residual, const PoseTable& run) {
  const auto spec = effects::EffectSpec::parse(text);
  if (!spec) return tl::unexpected(spec.error());
  if (spec->find("expr") == nullptr) return text;
  const auto candidate = tests::formula_candidate(*spec, model.problem.sensors());
  if (!candidate) return tl::unexpected(candidate.error());
  double least = 0;
  std::string best;
  for (const effects::EffectPtr& variant : candidate->variants) {
    const auto rows = rows_of(model, run, {variant->spec()});
    if (!rows) return tl::unexpected(rows.error());
    const double left = beyond_columns(residual.value(), residual.project(*rows).projected).squaredNorm();
    if (best.empty() || left < least) least = left, best = variant->spec();
  }
  return best;
}

/// Whether a has more coefficients than b, and can be what b is on the run.
bool wider(const HypothesisFit& fit, const std::vector<Eigen::MatrixXd>& columns, std::size_t a,
           std::size_t b) {
  if (fit.size[a].size() <= fit.size[b].size()) return false;
  const Eigen::VectorXd v = columns[b] * fit.size[b];
  return beyond_columns(v, columns[a]).norm() < kContained * v.norm();
}

std::vector<HypothesisPair> pairs_of(const HypothesisFit& fit, const std::vector<Eigen::MatrixXd>& columns) {
  const std::size_t n = fit.d.size();
  const auto holds_another = [&](std::size_t a) {
    for (std::size_t b = 0; b < n; ++b)
      if (wider(fit, columns, a, b)) return true;
    return false;
  };
  std::vector<std::size_t> asked;
  for (std::size_t a = 0; a < n; ++a)
    if (!holds_another(a)) asked.push_back(a);
  if (asked.size() < 2) {
    asked.clear();
    for (std::size_t a = 0; a < n; ++a) asked.push_back(a);
  }
  std::vector<HypothesisPair> out;
  for (std::size_t i = 0; i < asked.size(); ++i) {
    for (std::size_t j = i + 1; j < asked.size(); ++j) {
      const std::size_t a = asked[i], b = asked[j];
      const double weight = fit.hypotheses[a].P.value_or(1) * fit.hypotheses[b].P.value_or(1);
      out.push_back(fit.d[b] > fit.d[a] ? HypothesisPair{b, a, weight} : HypothesisPair{a, b, weight});
    }
  }
  return out;
}

}  // namespace

Result<HypothesisFit> hypothesis_fit(const PoseTable& run, const fit::joint::JointFit& fit,
                                     const fit::joint::JointOptions& options,
                                     std::vector<Hypothesis> hypotheses) {
  const auto model = model_on_poses(run, fit, options);
  if (!model) return tl::unexpected(model.error());
  const tests::Residual residual(model->problem, model->state, 0);
  HypothesisFit out;
  std::vector<Eigen::MatrixXd> all;
  for (Hypothesis& hypothesis : hypotheses) {
    for (std::string& spec : hypothesis.specs) {
      auto found = without_open_number(spec, *model, residual, run);
      if (!found) return tl::unexpected(found.error());
      spec = *std::move(found);
    }
    const auto rows = rows_of(*model, run, hypothesis.specs);
    if (!rows) return tl::unexpected(rows.error());
    tests::Residual::Columns columns = residual.project(*rows);
    if (!(columns.projected.norm() > kLeft * columns.norms.norm()))
      return fail(ErrorCode::refused,
                  fmt::format("{}: the calibration takes it up whole on these poses", hypothesis.name),
                  "such a law changes nothing; mgt define --try examines a formula");
    out.size.push_back(linear::least_squares(columns.projected, residual.value()));
    out.d.push_back((columns.projected * out.size.back()).norm());
    all.push_back(std::move(columns.projected));
  }
  out.hypotheses = std::move(hypotheses);
  out.pairs = pairs_of(out, all);
  out.assumed = *std::max_element(out.d.begin(), out.d.end()) < kAssumedBelow;
  for (std::size_t i = 0; out.assumed && i < out.size.size(); ++i)
    if (out.d[i] > 0) out.size[i] *= kAssumedBelow / out.d[i];
  return out;
}

Result<std::vector<double>> distances_on(const PoseTable& table, const HypothesisFit& hypotheses,
                                         const fit::joint::JointFit& fit,
                                         const fit::joint::JointOptions& options) {
  const auto model = model_on_poses(table, fit, options);
  if (!model) return tl::unexpected(model.error());
  const tests::Residual residual(model->problem, model->state, 0);
  std::vector<Eigen::MatrixXd> columns;
  for (const Hypothesis& hypothesis : hypotheses.hypotheses) {
    const auto rows = rows_of(*model, table, hypothesis.specs);
    if (!rows) return tl::unexpected(rows.error());
    columns.push_back(residual.project(*rows).projected);
  }
  std::vector<double> out;
  for (const HypothesisPair& pair : hypotheses.pairs)
    out.push_back(
        beyond_columns(columns[pair.truth] * hypotheses.size[pair.truth], columns[pair.other]).squaredNorm());
  return out;
}

Result<HypothesisRows> hypothesis_rows(const PoseTable& table, std::size_t of_run,
                                       const HypothesisFit& hypotheses, const fit::joint::JointFit& fit,
                                       const fit::joint::JointOptions& options) {
  const auto model = model_on_poses(table, fit, options);
  if (!model) return tl::unexpected(model.error());
  const tests::LinearRows linear = tests::linear_rows(model->problem, model->state);
  const tests::PriorRows priors = tests::prior_rows(model->problem, model->state);
  HypothesisRows out{.run = {}, .further = {}, .fixed = linear.fixed.cols(), .described = {}};
  Eigen::MatrixXd all = linear.fixed;
  for (std::size_t i = 0; i < hypotheses.hypotheses.size(); ++i) {
    const auto rows = rows_of(*model, table, hypotheses.hypotheses[i].specs);
    if (!rows) return tl::unexpected(rows.error());
    out.described.push_back({.first = all.cols(), .count = rows->cols(), .size = hypotheses.size[i]});
    all.conservativeResize(Eigen::NoChange, all.cols() + rows->cols());
    all.rightCols(rows->cols()) = *rows;
  }
  const tests::Whitener whitener(model->problem, linear.nuisance, 0);
  const Eigen::MatrixXd white = whitener.apply(all);
  const Eigen::Index each = whitener.rows_per_pose(), p = priors.fixed.rows();
  const Pose* const end = table.poses.data() + of_run;
  Eigen::Index fitted = 0;
  for (const fit::joint::JointPose& pose : model->problem.poses)
    if (pose.pose < end) ++fitted;
  for (Eigen::Index k = fitted; k < static_cast<Eigen::Index>(model->problem.poses.size()); ++k)
    out.further.emplace_back(white.middleRows(k * each, each));
  out.run = Eigen::MatrixXd::Zero(fitted * each + p, white.cols());
  out.run.topRows(fitted * each) = white.topRows(fitted * each);
  out.run.bottomLeftCorner(p, out.fixed) = priors.fixed;
  return out;
}

}  // namespace mgtd::calib::design
