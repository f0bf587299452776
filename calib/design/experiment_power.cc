// SPDX-License-Identifier: Apache-2.0
#include "calib/design/experiment_power.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "calib/criticism/tests/alternatives.h"
#include "calib/criticism/tests/rows.h"
#include "calib/design/actions.h"
#include "calib/design/experiment_design.h"
#include "calib/effects/library/effect_family.h"

namespace mgtd::calib::design {
namespace {

constexpr double kWorthTelling = 0.02;  ///< gain of a probability that is worth telling

bool one_place(const criticism::tests::CandidateEffect& candidate_effect,
               const criticism::tests::Hypothesis& h) {
  return candidate_effect.level == effects::Level::axis ? h.axes == 1
                                                        : &h == &candidate_effect.hypotheses.front();
}

bool of_array(const criticism::tests::Hypothesis& h) {
  const auto where = effects::Where::parse(h.where);
  return h.axes > 1 && !(where && where->sensor >= 0);
}

/// `b` acts where `a` does, and is no mere sum of effects of many places.
bool reaches(const criticism::tests::Hypothesis& b, const criticism::tests::Hypothesis& a,
             effects::Level level_b) {
  if (b.where == a.where) return true;
  if (of_array(a)) return of_array(b);
  if (of_array(b)) return level_b != effects::Level::axis;
  return b.where == a.where.substr(0, a.where.find('.'));
}

/// Everything an effect could be on these poses.
struct Shape {
  const criticism::tests::CandidateEffect* candidate_effect{nullptr};
  std::vector<criticism::tests::Signature> signatures;  ///< by variant
  std::vector<std::vector<Eigen::MatrixXd>> basis;      ///< by hypothesis, by variant
};

Shape shape_of(const DesignProblem& design, const criticism::tests::Residual& residual,
               const criticism::tests::CandidateEffect& candidate_effect) {
  Shape out{.candidate_effect = &candidate_effect, .signatures = {}, .basis = {}};
  for (const effects::EffectPtr& variant : candidate_effect.variants)
    out.signatures.emplace_back(residual,
                                criticism::tests::effect_source(design.problem, design.state, variant));
  for (const criticism::tests::Hypothesis& h : candidate_effect.hypotheses) {
    std::vector<Eigen::MatrixXd>& bases = out.basis.emplace_back();
    for (const criticism::tests::Signature& s : out.signatures)
      bases.emplace_back(s.times(criticism::tests::orthonormal_combinations(s, h)));
  }
  return out;
}

std::vector<Shape> shapes_of(const DesignProblem& design,
                             const std::vector<const criticism::tests::CandidateEffect*>& candidate_effects) {
  const criticism::tests::Residual residual(design.problem, design.state, 0);
  std::vector<Shape> out;
  for (const criticism::tests::CandidateEffect* const candidate_effect : candidate_effects)
    if (!candidate_effect->variants.empty()) out.push_back(shape_of(design, residual, *candidate_effect));
  return out;
}

/// Signature of a truth: coefficients alike in size and independent in sign. Of a searched number the value
/// in the middle.
Eigen::MatrixXd truth(const Shape& a, std::size_t hypothesis) {
  const std::size_t middle = a.signatures.size() / 2;
  if (a.basis[hypothesis][middle].cols() == 0) return {};
  return a.signatures[middle].times(a.candidate_effect->hypotheses[hypothesis].combine);
}

/// Largest share of `a` within `b`, in squares.
double alike(const Eigen::MatrixXd& a, const criticism::tests::Hypothesis& where, const Shape& b) {
  double most = 0;
  for (std::size_t h = 0; h < b.basis.size(); ++h) {
    if (!reaches(b.candidate_effect->hypotheses[h], where, b.candidate_effect->level)) continue;
    for (const Eigen::MatrixXd& U : b.basis[h])
      if (U.cols() > 0) most = std::max(most, (U.transpose() * a).squaredNorm());
  }
  return std::min(1.0, most / a.squaredNorm());
}

double named_right(double alike_share) {
  return criticism::tests::probability_right(kComparedAt_d * kComparedAt_d * (1 - alike_share));
}

struct Hardest {
  double alike{0};
  std::string where;
};

Hardest hardest(const Shape& a, const Shape& b) {
  Hardest out;
  for (std::size_t h = 0; h < a.basis.size(); ++h) {
    const criticism::tests::Hypothesis& where = a.candidate_effect->hypotheses[h];
    if (!one_place(*a.candidate_effect, where)) continue;
    const Eigen::MatrixXd signature = truth(a, h);
    if (signature.size() == 0) continue;
    const double share = alike(signature, where, b);
    if (share > out.alike) out = {share, where.where};
  }
  return out;
}

std::string advice(const std::string& effect, const std::string& alternative) {
  for (const auto& [of, with] : {std::pair{effect, alternative}, std::pair{alternative, effect}}) {
    const effects::library::EffectFamily* const family = effects::library::find_family(of);
    if (family == nullptr) continue;
    for (const effects::library::Confusion& c : family->confusions)
      if (c.with == with) return std::string(c.broken_by);
  }
  return {};
}

/// Both ways of each pair, the harder one kept.
std::vector<LookAlike> compare_all(const std::vector<Shape>& shapes, int& pairs) {
  std::vector<LookAlike> out;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    for (std::size_t j = i + 1; j < shapes.size(); ++j) {
      const Hardest ij = hardest(shapes[i], shapes[j]), ji = hardest(shapes[j], shapes[i]);
      if (ij.where.empty() && ji.where.empty()) continue;
      ++pairs;
      const bool first = ij.alike >= ji.alike;
      const Hardest& harder = first ? ij : ji;
      if (named_right(harder.alike) >= kSeparated) continue;
      const std::string &a = shapes[first ? i : j].candidate_effect->name,
                        &b = shapes[first ? j : i].candidate_effect->name;
      out.push_back({.effect = a,
                     .where = harder.where,
                     .alternative = b,
                     .correlation = std::sqrt(harder.alike),
                     .p_right = named_right(harder.alike),
                     .remedy = {},
                     .advice = advice(a, b)});
    }
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const auto& x, const auto& y) { return x.p_right < y.p_right; });
  return out;
}

/// The best action for each pair: the one that names it right most often, of equals the shortest.
void find_remedies(const DesignRequest& request, const PoseTable& table, const Action& action,
                   std::vector<LookAlike>& pairs) {
  const PoseTable longer = extended(table, action, request.sensors);
  const auto design = design_problem(request, longer);
  if (!design) return;
  const criticism::tests::CandidateEffects library =
      criticism::tests::library_candidates(longer, request.effects);
  std::set<std::string> wanted;
  for (const LookAlike& pair : pairs) wanted.insert({pair.effect, pair.alternative});
  std::vector<const criticism::tests::CandidateEffect*> candidate_effects;
  for (const criticism::tests::CandidateEffect& s : library.testable)
    if (wanted.contains(s.name)) candidate_effects.push_back(&s);
  const std::vector<Shape> shapes = shapes_of(*design, candidate_effects);
  std::map<std::string, const Shape*> by_name;
  for (const Shape& shape : shapes) by_name.emplace(shape.candidate_effect->name, &shape);
  const double minutes = action.extra_min + minutes_per_pose(table) * static_cast<double>(kActionPoses);
  for (LookAlike& pair : pairs) {
    if (!by_name.contains(pair.effect) || !by_name.contains(pair.alternative)) continue;
    const Shape &a = *by_name.at(pair.effect), &b = *by_name.at(pair.alternative);
    const double p = named_right(std::max(hardest(a, b).alike, hardest(b, a).alike));
    const double best = pair.remedy ? pair.remedy->p_right : pair.p_right;
    if (p > best + kWorthTelling) pair.remedy = Remedy{std::string(action.text), minutes, p};
  }
}

/// What would have to be larger than it ever is will not be seen.
criticism::tests::Detectable plausible(criticism::tests::Detectable found,
                                       const criticism::tests::CandidateEffect& candidate_effect) {
  if (candidate_effect.bound > 0 && found.value > candidate_effect.bound) found.value = 0;
  return found;
}

}  // namespace

Result<DesignProblem> design_problem(const DesignRequest& request, const PoseTable& table) {
  fit::joint::JointOptions options;
  options.geometry = request.geometry;
  options.effects = request.effects;
  options.table_sd_rad = request.table_sd_rad;
  if (request.field_known) options.field_nT = request.f_nT;
  if (request.field_sd_nT > 0) options.field_sd_nT = request.field_sd_nT;
  auto problem = fit::joint::joint_problem(table, options);
  if (!problem) return tl::unexpected(problem.error());
  DesignProblem out{.problem = std::move(*problem), .state = {}, .gauge = {}};
  out.gauge = fit::joint::fix_gauge(out.problem, options);
  fit::joint::weight_by_pose(
      out.problem, calibration::AxisNoise::Constant(out.problem.sensors(), 3, request.pose_noise_nT));
  out.state = fit::joint::joint_state(
      out.problem, request.sensors,
      fit::joint::direction_of(request.inclination_rad, request.declination_rad), request.f_nT);
  fit::joint::refit_nuisances(out.problem, out.state);
  return out;
}

Result<DesignPower> design_power(const DesignRequest& request, const PoseTable& table) {
  const auto design = design_problem(request, table);
  if (!design) return tl::unexpected(design.error());
  const criticism::tests::CandidateEffects library =
      criticism::tests::library_candidates(table, request.effects);
  DesignPower out;
  out.untestable = library.untestable;
  std::vector<const criticism::tests::CandidateEffect*> candidate_effects;
  for (const criticism::tests::CandidateEffect& s : library.testable) candidate_effects.push_back(&s);
  const std::vector<Shape> shapes = shapes_of(*design, candidate_effects);
  for (const Shape& shape : shapes)
    out.detectable.push_back(
        plausible(criticism::tests::detectable_of(*shape.candidate_effect, shape.signatures.front()),
                  *shape.candidate_effect));
  out.inseparable = compare_all(shapes, out.pairs);
  for (const Action& action : actions())
    if (!action.moved) find_remedies(request, table, action, out.inseparable);
  return out;
}

}  // namespace mgtd::calib::design
