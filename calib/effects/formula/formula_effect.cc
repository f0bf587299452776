// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/formula/formula_effect.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calib/effects/formula/history_name.h"
#include "calib/effects/formula/run_values.h"
#include "calib/effects/laws/axis_effect.h"
#include "calib/effects/laws/run_memory.h"
#include "calib/effects/laws/site_gradient.h"

namespace mgtd::calib::effects::formula {
namespace {

using Source = FormulaName::Source;

/// Steps of the differences, in the unit of the input.
double step_of(Level level, std::size_t input) {
  constexpr double kField_nT = 20, kGravity = 1e-3, kPlace_m = 1e-3;
  if (level == Level::site) return kPlace_m;
  return input < 3 ? kField_nT : kGravity;
}

std::size_t count_coefficients(const std::vector<FormulaName>& names) {
  std::size_t out = 0;
  for (const FormulaName& n : names)
    if (n.source == Source::coefficient) out = std::max(out, n.index + 1);
  return out;
}

/// sum += factor x.
void add_times(double factor, double x, double& sum) { sum += factor * x; }
void add_times(double factor, const Jet& x, Jet& sum) {
  sum.v += factor * x.v;
  sum.d += factor * x.d;
}

laws::AxisCoefficients per_axis(std::size_t count, const std::string& unit, double typical) {
  laws::AxisCoefficients out{.suffix = {}, .unit = unit, .typical = typical};
  for (auto& suffix : out.suffix) {
    for (std::size_t j = 0; j < count; ++j) suffix.push_back(count == 1 ? "" : fmt::format(".k{}", j + 1));
  }
  return out;
}

}  // namespace

FormulaEffect::FormulaEffect(EffectSpec spec, Level level, bool gradient, Expression expression,
                             std::vector<FormulaName> names, const std::string& unit, double prior_sd)
    : spec_(std::move(spec)),
      level_(level),
      gradient_(gradient),
      expression_(std::move(expression)),
      names_(std::move(names)),
      per_axis_(std::max<std::size_t>(1, count_coefficients(names_))),
      implicit_(count_coefficients(names_) == 0),
      scale_(per_axis(per_axis_, unit, prior_sd > 0 ? prior_sd : 1), *spec_.where) {
  if (level_ == Level::site) {
    add_of_site(unit, prior_sd > 0 ? prior_sd : 1);
  } else {
    coefficients_ = scale_.coefficients();
  }
  for (Coefficient& c : coefficients_) c.prior_sd = prior_sd;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const FormulaName& n = names_[i];
    if (n.source == Source::input) inputs_.push_back(n.index);
    if (n.source == Source::history) looking_back_.push_back({i, history_name(n.name)->kind});
    uses_own_ = uses_own_ || n.source == Source::own;
  }
}

void FormulaEffect::add_of_site(const std::string& unit, double typical) {
  const std::vector<std::string_view> components =
      gradient_
          ? std::vector<std::string_view>{laws::kGradientComponents.begin(), laws::kGradientComponents.end()}
          : std::vector<std::string_view>{"x", "y", "z"};
  for (const std::string_view component : components) {
    for (std::size_t j = 0; j < per_axis_; ++j) {
      site_.push_back(static_cast<int>(coefficients_.size()));
      coefficients_.push_back(
          {.name = per_axis_ == 1 ? std::string(component) : fmt::format("{}.k{}", component, j + 1),
           .unit = unit,
           .typical = typical});
    }
  }
}

std::size_t FormulaEffect::place_before(std::size_t looking_back, int sensor, int axis) const {
  const auto channel = static_cast<std::size_t>(3 * sensor + axis);
  return looking_back * 3 * static_cast<std::size_t>(scale_.sensors()) + channel;
}

Result<std::shared_ptr<const Effect>> FormulaEffect::bound(const EffectContext& context) const {
  if (looking_back_.empty()) return std::shared_ptr<const Effect>();
  const auto run = RunValues::of(context);
  if (!run) return tl::unexpected(run.error());
  auto before = std::make_shared<Before>();
  for (std::size_t j = 0; j < looking_back_.size(); ++j) {
    for (int channel = 0; channel < 3 * scale_.sensors(); ++channel) {
      const std::vector<double> values = run->of(names_[looking_back_[j].name], channel / 3, channel % 3);
      for (std::size_t k = 0; k < values.size(); ++k) {
        std::vector<double>& at = (*before)[context.table->poses[k].number];
        at.resize(looking_back_.size() * 3 * static_cast<std::size_t>(scale_.sensors()));
        at[place_before(j, channel / 3, channel % 3)] = values[k];
      }
    }
  }
  auto out = std::make_shared<FormulaEffect>(*this);
  out->before_ = std::move(before);
  return out;
}

std::string_view FormulaEffect::missing(const Pose& pose) const {
  if (level_ == Level::site)
    if (const std::string_view angle = missing_angle(pose); !angle.empty()) return angle;
  for (std::size_t j = 0; j < looking_back_.size(); ++j) {
    if (!before_) return laws::kNoMemory;
    const auto found = before_->find(pose.number);
    if (found == before_->end()) return laws::kNoMemory;
    if (looking_back_[j].kind == HistoryName::Kind::previous) continue;  // the first pose has none
    for (int sensor = 0; sensor < scale_.sensors(); ++sensor)
      for (int axis = 0; axis < 3; ++axis)
        if (first(sensor, axis) >= 0 && !std::isfinite(found->second[place_before(j, sensor, axis)]))
          return names_[looking_back_[j].name].name;
  }
  for (const FormulaName& n : names_) {
    if (n.source == Source::column && !n.get(pose)) return n.name;
    if (n.source != Source::temperature) continue;
    for (int sensor = 0; sensor < scale_.sensors(); ++sensor) {
      if (!scale_.acts_on(sensor)) continue;
      if (const std::string_view column = laws::missing_temperature(pose, sensor); !column.empty())
        return column;
    }
  }
  return {};
}

int FormulaEffect::first(int sensor, int axis) const {
  return level_ == Level::site ? axis * static_cast<int>(per_axis_) : scale_.first(sensor, axis);
}

void FormulaEffect::set_conditions(const Conditions& at, int sensor, Values& values) const {
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const FormulaName& n = names_[i];
    if (n.source == Source::number) values[i] = n.number;
    if (n.source == Source::hours) values[i] = at.t_h;
    if (n.source == Source::temperature) values[i] = *at.pose.T_degC[static_cast<std::size_t>(sensor)];
    if (n.source == Source::column) values[i] = n.get(at.pose).value_or(0);
  }
}

void FormulaEffect::set_inputs(const Inputs& in, int axis, Values& values) const {
  for (std::size_t i = 0; i < names_.size(); ++i) {
    if (names_[i].source == Source::own) values[i] = in[static_cast<std::size_t>(axis)];
    if (names_[i].source == Source::input) values[i] = in[names_[i].index];
  }
}

bool FormulaEffect::set_before(const Conditions& at, int sensor, int axis, Values& values) const {
  if (looking_back_.empty()) return true;
  const std::vector<double>& before = before_->at(at.pose.number);
  bool all = true;
  for (std::size_t j = 0; j < looking_back_.size(); ++j) {
    const double x = before[place_before(j, sensor, axis)];
    values[looking_back_[j].name] = x;
    all = all && std::isfinite(x);
  }
  return all;
}

double FormulaEffect::value(Values& values, const Own& c) const {
  for (std::size_t i = 0; i < names_.size(); ++i) {
    if (names_[i].source == Source::coefficient) values[i] = c[names_[i].index];
  }
  const double out = expression_({values.data(), names_.size()});
  return implicit_ ? c[0] * out : out;
}

double FormulaEffect::slope(Values& values, const Inputs& in, int axis, std::size_t input,
                            const Own& c) const {
  const auto difference = [&](double h) {
    double sum = 0;
    for (const double side : {h, -h}) {
      Inputs moved = in;
      moved[input] += side;
      set_inputs(moved, axis, values);
      sum += (side > 0 ? 1 : -1) * value(values, c);
    }
    return sum / (2 * h);
  };
  const double h = step_of(level_, input);
  const double out = (4 * difference(h / 2) - difference(h)) / 3;
  set_inputs(in, axis, values);
  return out;
}

/// sum_j shape_j G_j x: the expression with one coefficient at a time is what its gradient is multiplied by.
template <class S>
void FormulaEffect::gradient_term(const Conditions& at, int sensor, std::span<const S> x,
                                  std::span<const S> c, std::span<S> out) const {
  std::fill(out.begin(), out.end(), S(0.0));
  Values values{};
  set_conditions(at, sensor, values);
  if (!set_before(at, sensor, 0, values)) return;
  std::array<S, laws::kGradientComponents.size()> g;
  g.fill(S(0.0));  // a jet is not initialised
  for (std::size_t j = 0; j < per_axis_; ++j) {
    Own unit{};
    unit[j] = 1;
    const double shape = value(values, unit);
    for (std::size_t m = 0; m < g.size(); ++m) add_times(shape, c[m * per_axis_ + j], g[m]);
  }
  laws::gradient_times(std::span<const S>(g), x, out);
}

void FormulaEffect::term(const Conditions& at, int sensor, std::span<const double> in,
                         std::span<const double> c, std::span<double> out) const {
  if (gradient_) return gradient_term(at, sensor, in, c, out);
  Values values{};
  Inputs inputs{};
  std::copy_n(in.begin(), std::min(in.size(), inputs.size()), inputs.begin());
  set_conditions(at, sensor, values);
  for (int axis = 0; axis < 3; ++axis) {
    const int from = first(sensor, axis);
    out[static_cast<std::size_t>(axis)] = 0;
    if (from < 0) continue;
    Own own{};
    std::copy_n(c.begin() + from, per_axis_, own.begin());
    set_inputs(inputs, axis, values);
    if (set_before(at, sensor, axis, values)) out[static_cast<std::size_t>(axis)] = value(values, own);
  }
}

void FormulaEffect::term(const Conditions& at, int sensor, std::span<const Jet> in, std::span<const Jet> c,
                         std::span<Jet> out) const {
  if (gradient_) return gradient_term(at, sensor, in, c, out);
  Values values{};
  Inputs inputs{};
  for (std::size_t i = 0; i < std::min(in.size(), inputs.size()); ++i) inputs[i] = in[i].v;
  set_conditions(at, sensor, values);
  for (int axis = 0; axis < 3; ++axis) {
    Jet& y = out[static_cast<std::size_t>(axis)];
    y = Jet(0.0);
    const int from = first(sensor, axis);
    if (from < 0) continue;
    set_inputs(inputs, axis, values);
    if (!set_before(at, sensor, axis, values)) continue;
    Own own{};
    bool any = false;
    for (std::size_t j = 0; j < per_axis_; ++j) {
      const Jet& coefficient = c[static_cast<std::size_t>(from) + j];
      own[j] = coefficient.v;
      any = any || coefficient.v != 0;
      Own unit{};
      unit[j] = 1;
      const double shape = value(values, unit);
      y.v += shape * coefficient.v;
      y.d += shape * coefficient.d;
    }
    if (!any) continue;
    for (const std::size_t input : inputs_) y.d += slope(values, inputs, axis, input, own) * in[input].d;
    const auto along = static_cast<std::size_t>(axis);
    if (uses_own_ && std::find(inputs_.begin(), inputs_.end(), along) == inputs_.end())
      y.d += slope(values, inputs, axis, along, own) * in[along].d;
  }
}

Result<void> FormulaEffect::applicable(const PoseTable& table) const {
  if (const auto ok = Effect::applicable(table); !ok) return ok;
  const std::vector<double> ones(kMaxActive, 1.0);
  for (const Pose& pose : table.poses) {
    for (int sensor = 0; sensor < static_cast<int>(pose.y_nT.size()); ++sensor) {
      Inputs in{};
      if (level_ != Level::site)
        for (std::size_t a = 0; a < 3; ++a)
          in[a] = pose.y_nT[static_cast<std::size_t>(sensor)][static_cast<Eigen::Index>(a)];
      std::array<double, 3> out{};
      const auto active = this->at(sensor).size();
      term({.pose = pose}, sensor, std::span<const double>(in), std::span<const double>(ones.data(), active),
           out);
      if (std::all_of(out.begin(), out.end(), [](double y) { return std::isfinite(y); })) continue;
      return fail(ErrorCode::refused,
                  fmt::format("{} has no value at pose {}, sensor s{}", name(), pose.number, sensor + 1),
                  "look at divisions, logarithms and roots in it");
    }
  }
  return {};
}

}  // namespace mgtd::calib::effects::formula
