// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/profile_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "calib/effects/formula/formula.h"
#include "calib/effects/library/effect_family.h"
#include "calib/effects/library/library.h"
#include "calib/fit/joint/joint_fit.h"
#include "calib/linear/ldlt.h"

namespace mgtd::calib::fit::joint {
namespace {

/// Of the chi-square: what a solution may miss while values are compared.
constexpr double kEnough = 1e-3;

/// A number that an effect's spec leaves open, and what is tried for it.
struct OpenNumber {
  std::string parameter;
  effects::library::Scan::Range range{effects::library::Scan::Range::linear};
  std::vector<double> values;
};

std::optional<OpenNumber> open_number(const effects::Effect& effect, const effects::EffectContext& context) {
  const auto spec = effects::EffectSpec::parse(effect.spec());
  if (!spec) return std::nullopt;
  if (const auto scan = effects::formula::open_scan(*spec))
    return OpenNumber{scan->parameter, effects::library::Scan::Range::linear, scan_values(*scan)};
  const effects::library::EffectFamily* family = effects::library::find_family(effect.name());
  if (family == nullptr || !family->scan || family->scan->optional || !spec->parameters.empty())
    return std::nullopt;
  return OpenNumber{std::string(family->scan->parameter), family->scan->range, scan_values(*family, context)};
}

/// A problem with its weights, and a state near its solution.
struct Fitted {
  JointProblem problem;
  JointState state;
};

/// Fit with all effects of `options`.
Result<Fitted> fit_with(const PoseTable& table, const JointOptions& options) {
  auto fit = fit_joint_at_size(table, options);
  if (!fit) return tl::unexpected(fit.error());
  return Fitted{std::move(fit->problem), std::move(fit->state)};
}

/// Fit without the effect in `slot`, which is then put in with zero coefficients: what starts at the wrong
/// place can keep a fit from settling.
Result<Fitted> fit_around(const PoseTable& table, const JointOptions& options, std::size_t slot) {
  JointOptions without = options;
  without.effects.erase(without.effects.begin() + static_cast<std::ptrdiff_t>(slot));
  const auto fit = fit_joint_at_size(table, without);
  if (!fit) return tl::unexpected(fit.error());
  auto problem = joint_problem(table, options);
  if (!problem) return tl::unexpected(problem.error());
  fix_gauge(*problem, options);
  for (std::size_t k = 0; k < problem->poses.size(); ++k) {
    problem->poses[k].weight = fit->problem.poses[k].weight;
    problem->poses[k].attitude_weight = fit->problem.poses[k].attitude_weight;
  }
  Fitted out{std::move(*problem), fit->state};
  Eigen::Index first = 0;
  for (std::size_t i = 0; i < slot; ++i)
    first += static_cast<Eigen::Index>(out.problem.effects[i]->coefficients().size());
  const auto own = static_cast<Eigen::Index>(out.problem.effects[slot]->coefficients().size());
  const Eigen::VectorXd& known = fit->state.coefficients;
  out.state.coefficients = Eigen::VectorXd::Zero(known.size() + own);
  out.state.coefficients.head(first) = known.head(first);
  out.state.coefficients.tail(known.size() - first) = known.tail(known.size() - first);
  return out;
}

/// One searched effect of a fitted problem.
class Search {
 public:
  Search(Fitted fitted, const effects::EffectContext& context, std::size_t slot, OpenNumber number)
      : problem_(std::move(fitted.problem)),
        state_(std::move(fitted.state)),
        context_(context),
        slot_(slot),
        number_(std::move(number)),
        spec_(*effects::EffectSpec::parse(problem_.effects[slot]->spec())) {}

  /// The effect with the value that leaves the least; null when none could be fitted.
  effects::EffectPtr best() {
    std::vector<double> grid = number_.values;
    if (number_.range == effects::library::Scan::Range::index) grid = promising(std::move(grid));
    std::size_t at = 0;
    for (std::size_t i = 0; i < grid.size(); ++i) {
      if (const double cost = cost_of(grid[i]); cost < best_cost_) best_cost_ = cost, at = i;
    }
    if (!std::isfinite(best_cost_)) return nullptr;
    double value = grid[at];
    const effects::library::Scan::Range range = number_.range;
    if (range == effects::library::Scan::Range::linear || range == effects::library::Scan::Range::logarithmic)
      value = refine(grid[at > 0 ? at - 1 : 0], grid[std::min(at + 1, grid.size() - 1)], value);
    if (range == effects::library::Scan::Range::run) {
      for (const double t : effects::library::run_gaps_h(context_)) {
        if (t <= grid[at > 0 ? at - 1 : 0] || t >= grid[std::min(at + 1, grid.size() - 1)]) continue;
        if (const double cost = cost_of(t); cost < best_cost_) best_cost_ = cost, value = t;
      }
    }
    return effect_at(value);
  }

 private:
  [[nodiscard]] effects::EffectPtr effect_at(double value) const {
    effects::EffectSpec spec = spec_;
    spec.set(number_.parameter, value);
    auto effect = effects::library::make_effect(spec, context_);
    return effect ? *effect : nullptr;
  }

  /// The places with the largest fall of the chi-square to first order.
  std::vector<double> promising(std::vector<double> values) {
    constexpr std::size_t kTried = 3;
    std::vector<std::pair<double, double>> ranked;
    for (const double value : values) {
      if (const effects::EffectPtr effect = effect_at(value)) {
        problem_.effects[slot_] = effect;
        ranked.emplace_back(-predicted_fall(), value);
      }
    }
    std::sort(ranked.begin(), ranked.end());
    values.clear();
    for (std::size_t i = 0; i < std::min(kTried, ranked.size()); ++i) values.push_back(ranked[i].second);
    return values;
  }

  [[nodiscard]] double predicted_fall() const {
    const Reduced reduced = reduce(problem_, state_, 0);
    return reduced.g.dot(linear::solve_by_scaled_ldlt(reduced.S, reduced.g));
  }

  double cost_of(double value) {
    const effects::EffectPtr effect = effect_at(value);
    if (!effect) return std::numeric_limits<double>::infinity();
    problem_.effects[slot_] = effect;
    const auto solution = solve(problem_, state_, kEnough);
    return solution ? solution->reduced.cost.total() : std::numeric_limits<double>::infinity();
  }

  /// By golden section: Boost.Math's brent_find_minima lays a parabola through three costs, and the cost of a
  /// value at which the fit fails is infinite.
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
  const effects::EffectContext& context_;
  std::size_t slot_;
  OpenNumber number_;
  effects::EffectSpec spec_;
  double best_cost_{std::numeric_limits<double>::infinity()};
};

/// Puts back, weighed as the others of their channel, the readings that a fit left out. False: there are
/// none.
bool bring_back(JointProblem& problem) {
  Channels heaviest = Channels::Zero(problem.channels());
  for (const JointPose& pose : problem.poses) heaviest = heaviest.cwiseMax(pose.weight);
  bool any = false;
  for (JointPose& pose : problem.poses) {
    const auto left_out = (pose.weight.array() == 0).eval();
    any = any || left_out.any();
    pose.weight = left_out.select(heaviest, pose.weight);
  }
  return any;
}

/// What a model leaves, each reading that its fit leaves out counted as five standard deviations.
double price_of(const PoseTable& table, JointOptions options, std::size_t slot,
                const effects::EffectPtr& effect) {
  constexpr double kLeftOut = 25;
  if (!effect) return std::numeric_limits<double>::infinity();
  options.effects[slot] = effect;
  const auto fit = fit_joint_at_size(table, options);
  return fit ? fit->chi2 + kLeftOut * static_cast<double>(fit->outliers.size())
             : std::numeric_limits<double>::infinity();
}

/// The effect in `slot` with its number; null when none could be fitted.
effects::EffectPtr searched(const PoseTable& table, const JointOptions& options, Fitted fitted,
                            const effects::EffectContext& context, std::size_t slot,
                            const OpenNumber& number) {
  Fitted all = fitted;
  effects::EffectPtr best = Search(std::move(fitted), context, slot, number).best();
  // Beside a wrong moment the fit leaves out the poses between it and the right one, which alone tell.
  if (number.range != effects::library::Scan::Range::run || !bring_back(all.problem)) return best;
  effects::EffectPtr other = Search(std::move(all), context, slot, number).best();
  const bool better = price_of(table, options, slot, other) < price_of(table, options, slot, best);
  return better ? other : best;
}

}  // namespace

Result<std::vector<effects::EffectPtr>> profile_search(const PoseTable& table, const JointOptions& options) {
  const effects::EffectContext context{.table = &table, .offset_nT = {}};
  JointOptions profiled = options;
  std::vector<std::pair<std::size_t, OpenNumber>> open;
  for (std::size_t i = 0; i < options.effects.size(); ++i) {
    if (auto number = open_number(*options.effects[i], context)) open.emplace_back(i, std::move(*number));
  }
  const int rounds = open.empty() ? 0 : open.size() == 1 ? 1 : 2;
  for (int round = 0; round < rounds; ++round) {
    for (const auto& [slot, number] : open) {
      JointOptions others = profiled;
      others.effects[slot] = options.effects[slot];
      auto fitted = number.range == effects::library::Scan::Range::index ? fit_around(table, others, slot)
                                                                         : fit_with(table, others);
      if (!fitted) return tl::unexpected(fitted.error());
      if (effects::EffectPtr best = searched(table, others, std::move(*fitted), context, slot, number))
        profiled.effects[slot] = std::move(best);
    }
  }
  return profiled.effects;
}

}  // namespace mgtd::calib::fit::joint
