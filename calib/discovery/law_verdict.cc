// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/law_verdict.h"

#include <algorithm>
#include <cmath>

#include "calib/criticism/tests/multiplicity.h"
#include "calib/criticism/tests/wandering_alternative.h"
#include "calib/fit/joint/single_samples.h"
#include "calib/stats/chi_square.h"

namespace mgtd::calib::discovery {
namespace {

namespace tests = criticism::tests;

/// P above which a formula is the law.
constexpr double kSure = 0.9;
/// 2 ln of the odds that formulas need against what is random.
constexpr double kOverRandom = 6;
/// Of what an axis may have left beyond its noise, in standard deviations.
constexpr double kLeft = 3.7;

/// A law must be better than the walk as the tests of the library see it, where those found one.
bool beats_walk(const NoiseInForce& in_force, const FittedLaw& head, double questions) {
  if (!in_force.wanders) return true;
  const tests::WanderingAlternative alternative(in_force.fit);
  if (!alternative.estimate().any()) return true;
  const fit::joint::JointProblem& problem = in_force.fit.problem;
  const Eigen::MatrixXd of_gradient = gradient_rows(problem, in_force.fit.state);
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(problem.poses.size()) * problem.pose_rows(),
                       static_cast<Eigen::Index>(head.basis.size()));
  for (std::size_t j = 0; j < head.basis.size(); ++j)
    rows.col(static_cast<Eigen::Index>(j)) = law_rows(head.basis[j], problem, of_gradient);
  const auto ratio = alternative.ratio(rows);
  if (ratio.rank == 0) return false;
  const double log10_p = stats::chi_square_log10_p(std::max(0.0, ratio.R), ratio.rank) +
                         std::log10(head.place.alike(problem.channels()));
  return stands_out(tests::best_of(std::min(0.0, log10_p), questions));
}

}  // namespace

std::string_view to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass:
      return "PASS";
    case Verdict::law:
      return "LAW";
    case Verdict::law_set:
      return "LAW-SET";
    case Verdict::library:
      return "LIBRARY";
    case Verdict::shape_only:
      return "SHAPE-ONLY";
    case Verdict::noise_like:
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

Verdict verdict_of(const NoiseInForce& in_force, const std::vector<ChosenLaw>& laws,
                   const DiscoveryReport& report) {
  const bool left = report.left_sigmas > kLeft;
  if (laws.empty() || !stands_out(laws.front().law.log10_p))
    return in_force.wanders || left ? Verdict::noise_like : Verdict::pass;
  const FoundLaw& first = laws.front().law;
  const double over_random = std::min(first.over_walk, first.over_jumps);
  if (!beats_walk(in_force, laws.front().head, report.questions)) return Verdict::noise_like;
  if (first.random_beside) return Verdict::shape_only;
  if (over_random < 0) return Verdict::noise_like;
  if (over_random < kOverRandom || report.may_be_drift) return Verdict::shape_only;
  if (first.formulas.front().columns.empty()) return Verdict::library;
  if (stands_out(report.log10_p_left) || left) return Verdict::shape_only;
  const bool sure = std::all_of(laws.begin(), laws.end(),
                                [](const ChosenLaw& law) { return law.law.formulas.front().P > kSure; });
  return sure ? Verdict::law : Verdict::law_set;
}

}  // namespace mgtd::calib::discovery
