// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/law_verdict.h"

#include <algorithm>
#include <cmath>

#include "calib/criticism/tests/multiplicity.h"
#include "calib/criticism/tests/wandering_alternative.h"
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
bool beats_walk(const NoiseInForce& in_force, const ChosenLaw& chosen, double questions) {
  if (!in_force.wanders || chosen.law.formulas.front().specs.empty()) return true;
  const tests::WanderingAlternative alternative(in_force.fit);
  if (!alternative.estimate().any()) return true;
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(
      static_cast<Eigen::Index>(in_force.fit.problem.poses.size()) * in_force.fit.problem.pose_rows(),
      static_cast<Eigen::Index>(chosen.head.basis.size()));
  for (std::size_t j = 0; j < chosen.head.basis.size(); ++j)
    for (std::size_t c = 0; c < chosen.head.basis[j].size(); ++c)
      for (Eigen::Index k = 0; k < chosen.head.basis[j][c].size(); ++k)
        rows(k * in_force.fit.problem.pose_rows() + static_cast<Eigen::Index>(c),
             static_cast<Eigen::Index>(j)) =
            in_force.fit.problem.poses[static_cast<std::size_t>(k)].weight[static_cast<Eigen::Index>(c)] *
            chosen.head.basis[j][c][k];
  const auto ratio = alternative.ratio(rows);
  if (ratio.rank == 0) return false;
  const double log10_p = stats::chi_square_log10_p(std::max(0.0, ratio.R), ratio.rank) +
                         std::log10(chosen.head.place.alike(in_force.fit.problem.channels()));
  return tests::best_of(std::min(0.0, log10_p), questions) < std::log10(kFalseDiscovery);
}

bool significant(double log10_p) { return log10_p < std::log10(kFalseDiscovery); }

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

Verdict verdict_of(const NoiseInForce& in_force, const std::vector<ChosenLaw>& laws,
                   const DiscoveryReport& report) {
  const bool left = report.left_sigmas > kLeft;
  if (laws.empty() || !significant(laws.front().law.log10_p))
    return in_force.wanders || left ? Verdict::noise_like : Verdict::pass;
  const FoundLaw& first = laws.front().law;
  const double over_random = std::min(first.over_walk, first.over_jumps);
  if (first.random_beside) return Verdict::shape_only;
  if (over_random < 0 || !beats_walk(in_force, laws.front(), report.questions)) return Verdict::noise_like;
  if (over_random < kOverRandom) return Verdict::shape_only;
  if (first.formulas.front().columns.empty()) return Verdict::library;
  if (significant(report.log10_p_left) || left) return Verdict::shape_only;
  const bool sure = std::all_of(laws.begin(), laws.end(),
                                [](const ChosenLaw& law) { return law.law.formulas.front().P > kSure; });
  return sure ? Verdict::law : Verdict::law_set;
}

}  // namespace mgtd::calib::discovery
