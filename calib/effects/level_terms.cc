// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/level_terms.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace mgtd::calib::effects {
namespace {

/// unit()[i] has derivative one in slot i; copied, because setting a jet to zero costs more than the
/// equations.
const std::array<Jet, kJetSlots>& unit() {
  static const std::array<Jet, kJetSlots> jets = [] {
    std::array<Jet, kJetSlots> made;
    for (int i = 0; i < kJetSlots; ++i) made[static_cast<std::size_t>(i)] = Jet::variable(0, i);
    return made;
  }();
  return jets;
}

}  // namespace

LevelTerms::LevelTerms(const std::vector<EffectPtr>& effects, Level level) : level_(level) {
  int first = 0;
  for (const EffectPtr& effect : effects) {
    if (effect->level() == level) entries_.push_back({effect.get(), first});
    first += static_cast<int>(effect->coefficients().size());
  }
}

TermSum LevelTerms::sum(const Conditions& at, int sensor, std::span<const double> in,
                        const Eigen::VectorXd& coefficients) const {
  TermSum total;
  sum(at, sensor, in, coefficients, total);
  return total;
}

void LevelTerms::sum(const Conditions& at, int sensor, std::span<const double> in,
                     const Eigen::VectorXd& coefficients, TermSum& total) const {
  const int inputs = inputs_of(level_), outputs = outputs_of(level_);
  total.value.setZero(outputs);
  total.d_input.setZero(outputs, inputs);
  total.d_coefficient.setZero(outputs, coefficients.size());

  const auto& one = unit();
  std::array<Jet, kMaxTermInputs> x;
  for (std::size_t i = 0; i < in.size(); ++i) {
    x[i] = one[i];
    x[i].v = in[i];
  }
  for (const Entry& entry : entries_) {
    if (!entry.effect->missing(at.pose).empty()) continue;
    const std::span<const int> active = entry.effect->active(at, sensor);
    if (add_at_zero(entry, at, sensor, in, active, coefficients, total)) continue;
    std::array<Jet, kJetSlots> c;
    std::array<Jet, kMaxTermOutputs> out;
    for (std::size_t j = 0; j < active.size(); ++j) {
      c[j] = one[in.size() + j];
      c[j].v = coefficients[entry.first + active[j]];
    }
    entry.effect->term(at, sensor, std::span<const Jet>(x.data(), static_cast<std::size_t>(inputs)),
                       std::span<const Jet>(c.data(), active.size()),
                       std::span<Jet>(out.data(), static_cast<std::size_t>(outputs)));
    for (int o = 0; o < outputs; ++o) {
      const Jet& y = out[static_cast<std::size_t>(o)];
      total.value[o] += y.v;
      total.d_input.row(o) += y.d.head(inputs).matrix().transpose();
      for (std::size_t j = 0; j < active.size(); ++j) {
        total.d_coefficient(o, entry.first + active[j]) += y.d[inputs + static_cast<int>(j)];
      }
    }
  }
}

bool LevelTerms::add_at_zero(const Entry& entry, const Conditions& at, int sensor, std::span<const double> in,
                             std::span<const int> active, const Eigen::VectorXd& coefficients,
                             TermSum& total) {
  const auto is_zero = [&](int j) { return coefficients[entry.first + j] == 0; };
  if (!std::all_of(active.begin(), active.end(), is_zero)) return false;
  const auto outputs = static_cast<std::size_t>(total.value.size());
  std::array<double, std::size_t{kMaxTermOutputs} * kMaxActive> by_coefficient;
  if (!entry.effect->shapes(at, sensor, in, {by_coefficient.data(), outputs * active.size()})) return false;
  for (std::size_t j = 0; j < active.size(); ++j) {
    for (std::size_t o = 0; o < outputs; ++o)
      total.d_coefficient(static_cast<Eigen::Index>(o), entry.first + active[j]) +=
          by_coefficient[o + outputs * j];
  }
  return true;
}

TermValue LevelTerms::value(const Conditions& at, int sensor, std::span<const double> in,
                            const Eigen::VectorXd& coefficients) const {
  const auto outputs = static_cast<std::size_t>(outputs_of(level_));
  TermValue total = TermValue::Zero(outputs_of(level_));
  for (const Entry& entry : entries_) {
    if (!entry.effect->missing(at.pose).empty()) continue;
    const std::span<const int> active = entry.effect->active(at, sensor);
    std::array<double, kJetSlots> c{};
    std::array<double, kMaxTermOutputs> out{};
    for (std::size_t j = 0; j < active.size(); ++j) c[j] = coefficients[entry.first + active[j]];
    entry.effect->term(at, sensor, in, std::span<const double>(c.data(), active.size()),
                       std::span<double>(out.data(), outputs));
    for (std::size_t o = 0; o < outputs; ++o) total[static_cast<Eigen::Index>(o)] += out[o];
  }
  return total;
}

double LevelTerms::sd_nT_per_rad(const Conditions& at, int sensor, int axis,
                                 const Eigen::VectorXd& coefficients) const {
  double variance = 0;
  for (const Entry& entry : entries_) {
    if (!entry.effect->missing(at.pose).empty()) continue;
    const std::span<const int> active = entry.effect->active(at, sensor);
    std::array<double, kMaxActive> c;
    for (std::size_t j = 0; j < active.size(); ++j) c[j] = coefficients[entry.first + active[j]];
    const double sd = entry.effect->sd_nT_per_rad(at, sensor, axis, {c.data(), active.size()});
    variance += sd * sd;
  }
  return std::sqrt(variance);
}

}  // namespace mgtd::calib::effects
