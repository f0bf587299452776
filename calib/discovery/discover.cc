// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/discover.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "calib/criticism/tests/judgement.h"
#include "calib/criticism/tests/multiplicity.h"
#include "calib/discovery/argument_noise.h"
#include "calib/discovery/law_checks.h"
#include "calib/discovery/law_finding.h"
#include "calib/discovery/law_sequence.h"
#include "calib/discovery/noise_in_force.h"
#include "calib/effects/library/library.h"
#include "calib/fit/joint/cross_validation.h"
#include "calib/fit/joint/joint_report.h"
#include "calib/fit/joint/pose_residuals.h"
#include "calib/sensor/channels.h"

namespace mgtd::calib::discovery {
namespace {

namespace tests = criticism::tests;

/// A fit with the first formula of some laws, which starts from the one without them; empty where one of them
/// is no effect, or the fit does not settle.
Result<std::optional<fit::joint::JointFit>> fit_with(const PoseTable& table, fit::FitOptions options,
                                                     const fit::joint::JointFit& without,
                                                     const std::vector<std::string>& specs) {
  for (const std::string& spec : specs) {
    auto effect = effects::library::make_effect(spec, without.problem.sensors());
    if (!effect) return std::nullopt;
    options.effects.push_back(*std::move(effect));
  }
  auto joint = fit::joint::profiled_options(table, options);
  if (!joint) return tl::unexpected(joint.error());
  joint->noise_inflation = without.noise_inflation;
  Eigen::Index coefficients = 0;
  for (const effects::EffectPtr& effect : joint->effects)
    coefficients += static_cast<Eigen::Index>(effect->coefficients().size());
  fit::joint::JointState start = without.state;
  start.coefficients.conservativeResizeLike(Eigen::VectorXd::Zero(coefficients));
  auto fit = fit::joint::fit_joint_at_size(table, *joint, &start);
  if (!fit) return std::nullopt;
  if (!(fit->noise_inflation > 1)) return *std::move(fit);
  // Where the law accounts for nearly all the noise is no longer inflated: as in a fit that begins so.
  joint->noise_inflation = 1;
  auto again = fit::joint::fit_joint_at_size(table, *joint, &fit->state);
  return again ? *std::move(again) : *std::move(fit);
}

/// The noise that the search stands against. Where the residual says that it is larger than the readings do,
/// or lasts, the law itself may say so: it is judged again with the leading formula in the model.
Result<NoiseInForce> noise_of(const PoseTable& table, const DiscoverOptions& options,
                              const fit::joint::JointFit& fit, const tests::CandidateEffects& candidates,
                              const Grammar& formulas, const FormulaValues& values, LawInputs& inputs) {
  constexpr int kTries = 2;
  NoiseInForce out = noise_in_force(fit, candidates, options.fit.seed);
  for (int i = 0; i < kTries; ++i) {
    const bool doubtful =
        out.noise.scale2 != 1 || out.residual.whitener().rho() != 0 || out.wanders || fit.noise_inflation > 1;
    if (!doubtful) break;
    const ChannelSums sums(out.fit, out.residual);
    const FormulaProducts products(values, sums);
    const Workbench bench{.grammar = formulas,
                          .inputs = inputs,
                          .products = products,
                          .problem = out.fit.problem,
                          .residual = out.residual,
                          .noise = out.noise};
    const auto round = law_round(bench, sums, false);
    if (!round) return tl::unexpected(round.error());
    const auto leading = chosen_law(bench, sums, *round, 1, "law1");
    if (!leading) return tl::unexpected(leading.error());
    const auto& specs = leading->law.formulas.front().specs;
    if (specs.empty()) break;
    const auto with = fit_with(table, options.fit, fit, specs);
    if (!with) return tl::unexpected(with.error());
    if (!*with) break;
    const auto variance_nT2 = variance_of_angles(leading->head, fit.table_sd_rad, inputs);
    if (!variance_nT2) return tl::unexpected(variance_nT2.error());
    const auto weighed = beside_variance(tests::at_stated_weights(**with), *variance_nT2);
    out = noise_beside_law(fit, noise_in_force(weighed, candidates, options.fit.seed));
  }
  return out;
}

bool fitted(const Pose& pose) { return pose.set != "check"; }

/// Of the poses of a run some, evenly: the others stay in it as poses that no fit takes, and what looks back
/// over the run sees them.
PoseTable every_few(PoseTable table, std::size_t most) {
  const auto all = static_cast<std::size_t>(std::count_if(table.poses.begin(), table.poses.end(), fitted));
  if (all <= most) return table;
  std::size_t k = 0, taken = 0;
  for (Pose& pose : table.poses) {
    if (!fitted(pose)) continue;
    if (k++ == taken * all / most) {
      ++taken;
    } else {
      pose.set = "check";
    }
  }
  return table;
}

std::vector<tests::ScoredFamily> scored_library(const NoiseInForce& in_force,
                                                const tests::CandidateEffects& candidates) {
  std::vector<const tests::CandidateEffect*> scored;
  for (const tests::CandidateEffect& candidate : candidates.testable)
    if (!candidate.dipole_at) scored.push_back(&candidate);  // explain looks for its place
  return tests::score_families(in_force.fit.problem, in_force.fit.state, in_force.residual, in_force.noise,
                               scored);
}

/// The leading formulas of some laws as effects; none where one of them is no effect.
std::vector<std::string> specs_of(std::span<const ChosenLaw> laws) {
  std::vector<std::string> out;
  for (const ChosenLaw& law : laws) {
    const std::vector<std::string>& of_law = law.law.formulas.front().specs;
    if (of_law.empty()) return {};
    out.insert(out.end(), of_law.begin(), of_law.end());
  }
  return out;
}

/// What laws leave in a fit with them.
struct LeftInFit {
  double log10_p{0};  ///< of the search
  LeftOn on;
  double random{0};  ///< 2 ln of the odds of an offset that walks or jumps
};

/// Empty where no such fit can be made.
Result<std::optional<LeftInFit>> left_in_fit(const PoseTable& table, const DiscoverOptions& options,
                                             const fit::joint::JointFit& fit, const NoiseInForce& in_force,
                                             const Workbench& bench, double questions,
                                             std::span<const ChosenLaw> laws) {
  const std::vector<std::string> specs = specs_of(laws);
  if (specs.empty()) return std::nullopt;
  const auto with = fit_with(table, options.fit, fit, specs);
  if (!with) return tl::unexpected(with.error());
  if (!*with || (*with)->problem.poses.size() != in_force.fit.problem.poses.size()) return std::nullopt;
  const NoiseInForce beside = noise_beside_law(**with, in_force);
  const ChannelSums sums(beside.fit, beside.residual);
  const FormulaProducts products(bench.products.values(), sums);
  const Workbench there{.grammar = bench.grammar,
                        .inputs = bench.inputs,
                        .products = products,
                        .problem = beside.fit.problem,
                        .residual = beside.residual,
                        .noise = beside.noise,
                        .library = {},
                        .looks = bench.looks};
  const auto left = law_round(there, sums, false);
  if (!left) return tl::unexpected(left.error());
  return LeftInFit{.log10_p = tests::best_of(left->log10_p_best, questions),
                   .on = left_on(sums),
                   .random = std::max(left->walk, left->jumps)};
}

/// What the laws leave says something against them.
bool something_left(const LawFindingReason& reason) {
  using Rule = LawFindingReason::Rule;
  return reason.rule == Rule::random_beside || reason.rule == Rule::law_left ||
         reason.rule == Rule::scatter_left;
}

/// The search stands on one linearisation about the fit without the laws, and a large law moves that fit: in
/// a fit with the stronger ones nothing may be left of a weaker law, or of what speaks against them all.
Result<void> judge_in_fit(const PoseTable& table, const DiscoverOptions& options,
                          const fit::joint::JointFit& fit, const NoiseInForce& in_force,
                          const Workbench& bench, std::vector<ChosenLaw>& laws, DiscoveryReport& out) {
  if (laws.size() < 2 && !something_left(out.reason)) return {};
  for (std::size_t m = 1; m <= laws.size(); ++m) {
    if (m == laws.size() && !something_left(out.reason)) return {};
    const auto left =
        left_in_fit(table, options, fit, in_force, bench, out.questions, std::span(laws).first(m));
    if (!left) return tl::unexpected(left.error());
    if (!*left) return {};
    if (m < laws.size() && stands_out((*left)->log10_p, options.looks)) continue;
    laws.resize(m);
    out.log10_p_left = (*left)->log10_p;
    out.left_sigmas = (*left)->on.sigmas, out.left_on = sensor::channel_name((*left)->on.channel);
    FoundLaw& first = laws.front().law;
    if (first.random_beside) {
      first.over_nothing_beside = (*left)->random;
      first.random_beside = first.over_nothing_beside > 0;
    }
  }
  const JudgedLaws judged = finding_of(in_force, laws, out, options.looks);
  out.finding = judged.finding, out.reason = judged.reason;
  return {};
}

/// The shape of the first law, and what no part of the choice has seen.
Result<void> check_first_law(const PoseTable& table, const DiscoverOptions& options,
                             const fit::joint::JointFit& fit, const NoiseInForce& in_force,
                             const Workbench& bench, ChannelSums sums, std::vector<ChosenLaw>& laws,
                             DiscoveryReport& out) {
  FoundLaw& first = laws.front().law;
  for (std::size_t i = 1; i < laws.size(); ++i) take_out(laws[i].head, sums);
  auto shape = law_shape(laws.front().alike, laws.front().covariates, bench.inputs, sums, options.fit.seed);
  if (!shape) return tl::unexpected(shape.error());
  first.shape = *std::move(shape);
  first.halves_ratio = halves_ratio(in_force.fit, in_force.noise.scale2, laws.front().head);
  const auto fall = held_out_fall(in_force.fit, in_force.residual, bench);
  if (!fall) return tl::unexpected(fall.error());
  first.held_out_fall = *fall;
  const auto spread = extrapolation_spread(laws.front().set, table, in_force.fit);
  if (!spread) return tl::unexpected(spread.error());
  first.extrapolation_spread = *spread;
  const std::vector<std::string> specs = specs_of(laws);
  if (specs.empty()) return {};
  const auto with = fit_with(table, options.fit, fit, specs);
  if (!with) return tl::unexpected(with.error());
  if (!*with) return {};
  out.after = {.residual_nT = fit::joint::pose_residuals((*with)->problem, (*with)->state).residual_nT(),
               .unseen_before_nT = fit::joint::left_out_nT(fit),
               .unseen_after_nT = fit::joint::left_out_nT(**with)};
  return {};
}

/// Of a run of at most as many poses as a search can hold.
Result<DiscoveryReport> discover_in(const PoseTable& run, const DiscoverOptions& options, std::size_t most) {
  const PoseTable table = every_few(run, most);
  const auto joint = fit::joint::profiled_options(table, options.fit);
  if (!joint) return tl::unexpected(joint.error());
  const auto fit = fit::joint::fit_joint_at_size(table, *joint);
  if (!fit) return tl::unexpected(fit.error());
  auto inputs = LawInputs::of(*fit, table);
  if (!inputs) return tl::unexpected(inputs.error());
  const Grammar formulas = grammar(*inputs);
  const auto values = FormulaValues::of(formulas, *inputs);
  if (!values) return tl::unexpected(values.error());
  const tests::CandidateEffects candidates = tests::library_candidates(table);
  const auto in_force = noise_of(table, options, *fit, candidates, formulas, *values, *inputs);
  if (!in_force) return tl::unexpected(in_force.error());
  const auto channels = static_cast<std::size_t>(fit->problem.channels());
  if (in_force->residual.whitener().rho() != 0 && fit->problem.poses.size() * channels > kMostCorrelated)
    return discover_in(run, options, kMostCorrelated / channels);
  const ChannelSums bare(in_force->fit, in_force->residual);
  const FormulaProducts products(*values, bare);
  const Workbench bench{.grammar = formulas,
                        .inputs = *inputs,
                        .products = products,
                        .problem = in_force->fit.problem,
                        .residual = in_force->residual,
                        .noise = in_force->noise,
                        .library = scored_library(*in_force, candidates),
                        .looks = options.looks};
  DiscoveryReport out;
  out.poses = static_cast<std::size_t>(std::count_if(run.poses.begin(), run.poses.end(), fitted));
  out.searched = fit->problem.poses.size();
  out.formulas = formulas.members(), out.grammar_hash = formulas.hash(), out.draws = options.draws;
  out.chi2 = in_force->residual.chi2(), out.dof = in_force->residual.dof();
  out.rho = in_force->residual.whitener().rho(), out.wanders = in_force->wanders;
  out.noise_nT = fit->noise_nT();
  out.residual_nT = fit::joint::pose_residuals(fit->problem, fit->state).residual_nT();
  out.questions = tests::questions_asked(
      best_of_noise(LawSearch(products, bare), bare, in_force->noise, options.draws, options.fit.seed));
  auto found = law_sequence(bench, bare, gradient_rows(bench.problem, in_force->fit.state), out.questions);
  if (!found) return tl::unexpected(found.error());
  out.hypotheses = found->hypotheses;
  out.log10_p_left = found->log10_p_left;
  const LeftOn left = left_on(found->left);
  out.left_sigmas = left.sigmas, out.left_on = sensor::channel_name(left.channel);
  out.may_be_drift = may_be_drift(*in_force, found->laws.front());
  const JudgedLaws judged = finding_of(*in_force, found->laws, out, options.looks);
  out.finding = judged.finding, out.reason = judged.reason;
  if (found->laws.front().law.stands_out)
    if (const auto ok = judge_in_fit(table, options, *fit, *in_force, bench, found->laws, out); !ok)
      return tl::unexpected(ok.error());
  if (found->laws.front().law.stands_out && options.checks)
    if (const auto ok = check_first_law(table, options, *fit, *in_force, bench, bare, found->laws, out); !ok)
      return tl::unexpected(ok.error());
  for (ChosenLaw& law : found->laws) out.laws.push_back(std::move(law.law));
  return out;
}

}  // namespace

Result<DiscoveryReport> discover(const PoseTable& run, const DiscoverOptions& options) {
  return discover_in(run, options, kMostPoses);
}

}  // namespace mgtd::calib::discovery
