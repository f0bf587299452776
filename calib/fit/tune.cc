// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/tune.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "calib/effects/effect_family.h"
#include "calib/fit/joint_fit.h"

namespace mgtd::calib {
namespace {

/// Of the chi-square: what a solution may miss while values are compared.
constexpr double kEnough = 1e-3;

/// A family whose number this effect's spec leaves open; null otherwise.
const EffectFamily* open_scan(const Effect& effect) {
  const EffectFamily* family = find_family(effect.name());
  if (family == nullptr || !family->scan || family->scan->optional) return nullptr;
  const auto spec = EffectSpec::parse(effect.spec());
  if (!spec || !spec->parameters.empty()) return nullptr;
  return family;
}

/// One searched effect of a fitted problem.
class Search {
 public:
  Search(const JointFit& fit, const EffectContext& context, std::size_t slot, const EffectFamily& family)
      : problem_(fit.problem),
        state_(fit.state),
        context_(context),
        slot_(slot),
        family_(family),
        spec_(*EffectSpec::parse(fit.problem.effects[slot]->spec())) {}

  /// The effect with the value that leaves the least; null when none could be fitted.
  EffectPtr best() {
    const std::vector<double> grid = scan_values(family_, context_);
    std::size_t at = 0;
    for (std::size_t i = 0; i < grid.size(); ++i) {
      if (const double cost = cost_of(grid[i]); cost < best_cost_) best_cost_ = cost, at = i;
    }
    if (!std::isfinite(best_cost_)) return nullptr;
    double value = grid[at];
    const Scan::Range range = family_.scan->range;
    if (range == Scan::Range::linear || range == Scan::Range::logarithmic)
      value = refine(grid[at > 0 ? at - 1 : 0], grid[std::min(at + 1, grid.size() - 1)], value);
    if (range == Scan::Range::run) {
      for (const double t : run_gaps_h(context_)) {
        if (t <= grid[at > 0 ? at - 1 : 0] || t >= grid[std::min(at + 1, grid.size() - 1)]) continue;
        if (const double cost = cost_of(t); cost < best_cost_) best_cost_ = cost, value = t;
      }
    }
    return effect_at(value);
  }

 private:
  [[nodiscard]] EffectPtr effect_at(double value) const {
    EffectSpec spec = spec_;
    spec.set(family_.scan->parameter, value);
    auto effect = make_effect(spec, context_);
    return effect ? *effect : nullptr;
  }

  double cost_of(double value) {
    const EffectPtr effect = effect_at(value);
    if (!effect) return std::numeric_limits<double>::infinity();
    problem_.effects[slot_] = effect;
    const auto solution = solve(problem_, state_, kEnough);
    return solution ? solution->reduced.cost.total() : std::numeric_limits<double>::infinity();
  }

  double refine(double low, double high, double value) {
    constexpr double kGolden = 0.6180339887498949;
    constexpr int kSteps = 12;  // to 0.3 % of the interval
    double a = high - kGolden * (high - low), b = low + kGolden * (high - low);
    double cost_a = cost_of(a), cost_b = cost_of(b);
    for (int i = 0; i < kSteps; ++i) {
      if (cost_a < cost_b) {
        high = b, b = a, cost_b = cost_a;
        cost_a = cost_of(a = high - kGolden * (high - low));
      } else {
        low = a, a = b, cost_a = cost_b;
        cost_b = cost_of(b = low + kGolden * (high - low));
      }
    }
    const double found = cost_a < cost_b ? a : b;
    return std::min(cost_a, cost_b) < best_cost_ ? found : value;
  }

  JointProblem problem_;
  JointState state_;
  const EffectContext& context_;
  std::size_t slot_;
  const EffectFamily& family_;
  EffectSpec spec_;
  double best_cost_{std::numeric_limits<double>::infinity()};
};

}  // namespace

Result<std::vector<EffectPtr>> tune(const PoseTable& table, const JointOptions& options) {
  const EffectContext context{.table = &table, .offset_nT = {}};
  JointOptions tuned = options;
  std::vector<std::pair<std::size_t, const EffectFamily*>> open;
  for (std::size_t i = 0; i < options.effects.size(); ++i) {
    if (const EffectFamily* family = open_scan(*options.effects[i])) open.emplace_back(i, family);
  }
  const int rounds = open.empty() ? 0 : open.size() == 1 ? 1 : 2;
  for (int round = 0; round < rounds; ++round) {
    for (const auto& [slot, family] : open) {
      JointOptions others = tuned;
      others.effects[slot] = options.effects[slot];
      const auto fit = fit_joint(table, others);
      if (!fit) return tl::unexpected(fit.error());
      if (EffectPtr best = Search(*fit, context, slot, *family).best()) tuned.effects[slot] = std::move(best);
    }
  }
  return tuned.effects;
}

}  // namespace mgtd::calib
