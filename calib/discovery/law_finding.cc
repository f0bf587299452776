// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/law_finding.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "calib/criticism/tests/multiplicity.h"
#include "calib/criticism/tests/wandering_alternative.h"
#include "calib/discovery/formula_parts.h"
#include "calib/fit/joint/single_samples.h"
#include "calib/stats/chi_square.h"

namespace mgtd::calib::discovery {
namespace {

namespace tests = criticism::tests;

/// 1 - P below which a formula is the law.
constexpr double kUnsure = 0.05;
/// 2 ln of the odds that formulas need against what is random, instead of them.
constexpr double kOverRandom = 6;
/// Of what an axis may have left beyond its noise, in standard deviations.
constexpr double kLeft = 3.7;
/// Of an oscillation in the run: what comes once is any curve.
constexpr double kPeriods = 2;

/// log10 p of a law beside the walk as the tests of the library see it; empty where those found none.
std::optional<double> log10_p_over_walk(const NoiseInForce& in_force, const FittedLaw& head,
                                        double questions) {
  if (!in_force.wanders) return std::nullopt;
  const tests::WanderingAlternative alternative(in_force.fit);
  if (!alternative.estimate().any()) return std::nullopt;
  const fit::joint::JointProblem& problem = in_force.fit.problem;
  const Eigen::MatrixXd of_gradient = gradient_rows(problem, in_force.fit.state);
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(problem.poses.size()) * problem.pose_rows(),
                       static_cast<Eigen::Index>(head.basis.size()));
  for (std::size_t j = 0; j < head.basis.size(); ++j)
    rows.col(static_cast<Eigen::Index>(j)) = law_rows(head.basis[j], problem, of_gradient);
  const auto ratio = alternative.ratio(rows);
  if (ratio.rank == 0) return 0;
  const double log10_p = stats::chi_square_log10_p(std::max(0.0, ratio.R), ratio.rank) +
                         std::log10(head.place.alike(problem.channels()));
  return tests::best_of(std::min(0.0, log10_p), questions);
}

/// Periods that the run lasts, where a law is an oscillation in time.
std::optional<double> periods_of(const FoundLaw& law, const fit::joint::JointProblem& problem) {
  const FoundFormula& first = law.formulas.front();
  if (!first.inner || first.inner_unit != kPeriodUnit) return std::nullopt;
  const auto [begin, end] = std::minmax_element(
      problem.poses.begin(), problem.poses.end(),
      [](const fit::joint::JointPose& a, const fit::joint::JointPose& b) { return a.t_h < b.t_h; });
  return (end->t_h - begin->t_h) / *first.inner;
}

double over_random(const FoundLaw& law) { return std::min(law.over_walk, law.over_jumps); }

}  // namespace

std::string_view to_string(LawFinding finding) {
  switch (finding) {
    case LawFinding::pass:
      return "PASS";
    case LawFinding::law:
      return "LAW";
    case LawFinding::law_set:
      return "LAW-SET";
    case LawFinding::library:
      return "LIBRARY";
    case LawFinding::shape_only:
      return "SHAPE-ONLY";
    case LawFinding::noise_like:
      return "NOISE-LIKE";
  }
  return "";
}

bool may_be_drift(const NoiseInForce& in_force, const ChosenLaw& first) {
  if (!fit::joint::is_recording(in_force.fit.problem)) return false;
  const auto reading = [](const std::string& name) {
    return name == "u" || name == "ux" || name == "uy" || name == "uz";
  };
  return in_force.residual.whitener().rho() != 0 || in_force.wanders ||
         !std::all_of(first.covariates.begin(), first.covariates.end(), reading);
}

JudgedLaws finding_of(const NoiseInForce& in_force, const std::vector<ChosenLaw>& laws,
                      const DiscoveryReport& report, int looks) {
  using Rule = LawFindingReason::Rule;
  const bool left = report.left_sigmas > kLeft;
  const double log10_p = laws.empty() ? 0 : laws.front().law.log10_p;
  if (!stands_out(log10_p, looks)) {
    if (left) return {LawFinding::noise_like, {Rule::only_scatter, report.left_sigmas, kLeft}};
    if (in_force.wanders) return {LawFinding::noise_like, {.rule = Rule::only_wander}};
    return {LawFinding::pass, {Rule::nothing_found, log10_p, limit_log10_p(looks)}};
  }
  const auto over_walk = log10_p_over_walk(in_force, laws.front().head, report.questions);
  if (over_walk && !stands_out(*over_walk, looks))
    return {LawFinding::noise_like, {Rule::walk_instead, *over_walk, limit_log10_p(looks)}};
  const FoundLaw& first = laws.front().law;
  if (first.random_beside)
    return {LawFinding::shape_only, {.rule = Rule::random_beside, .measured = first.over_nothing_beside}};
  const double needed = kOverRandom + 2 * std::log(looks);
  if (over_random(first) < 0)
    return {LawFinding::noise_like, {Rule::random_instead, over_random(first), needed}};
  for (std::size_t i = 0; i < laws.size(); ++i)
    if (over_random(laws[i].law) < needed)
      return {LawFinding::shape_only, {Rule::random_near, over_random(laws[i].law), needed, i}};
  if (report.may_be_drift) return {LawFinding::shape_only, {.rule = Rule::drift}};
  const double sure = 1 - kUnsure / looks;
  if (first.formulas.front().columns.empty())
    return {LawFinding::library, {Rule::library, first.formulas.front().P, sure}};
  for (std::size_t i = 0; i < laws.size(); ++i)
    if (const auto periods = periods_of(laws[i].law, in_force.fit.problem); periods && *periods < kPeriods)
      return {LawFinding::shape_only, {Rule::few_periods, *periods, kPeriods, i}};
  if (stands_out(report.log10_p_left, 1))
    return {LawFinding::shape_only, {Rule::law_left, report.log10_p_left, limit_log10_p(1)}};
  if (left) return {LawFinding::shape_only, {Rule::scatter_left, report.left_sigmas, kLeft}};
  for (std::size_t i = 0; i < laws.size(); ++i)
    if (const double P = laws[i].law.formulas.front().P; !(P > sure))
      return {LawFinding::law_set, {Rule::formulas_open, P, sure, i}};
  return {LawFinding::law, {.rule = Rule::none}};
}

}  // namespace mgtd::calib::discovery
