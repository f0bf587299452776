// SPDX-License-Identifier: Apache-2.0
#include "calib/validity/fixed_calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "calib/effects/library/library.h"
#include "calib/fit/joint/joint_problem.h"

namespace mgtd::calib::validity {
namespace {

void fix_sensors(const fit::joint::FixedSlots& slots, FixedCalibration& out) {
  for (int slot = 0; slot < slots.sensor_block(); ++slot) {
    out.tested.push_back(slot);
  }
  for (int slot = slots.site(); slot < slots.effects(); ++slot) out.nuisance.push_back(slot);
}

void fix_effect(const fit::joint::FixedSlots& slots, const calibration::CalibratedEffect& e,
                const effects::EffectPtr& effect, Eigen::Index row, std::vector<double>& values,
                std::vector<Eigen::Index>& rows, FixedCalibration& out) {
  const bool of_site = effect->level() == effects::Level::site;
  out.needs_angles = out.needs_angles || effect->level() != effects::Level::axis;
  out.effects.push_back(effect);
  if (!of_site) out.instrument.push_back(e);
  for (const calibration::EffectCoefficient& coefficient : e.coefficients) {
    const Eigen::Index slot = slots.effects() + static_cast<Eigen::Index>(values.size());
    (of_site ? out.nuisance : out.tested).push_back(slot);
    if (!of_site) rows.push_back(row);
    values.push_back(coefficient.value);
    ++row;
  }
}

Result<void> add_site_effect(const fit::joint::FixedSlots& slots, const effects::EffectPtr& effect,
                             std::vector<double>& values, FixedCalibration& out) {
  if (effect->level() != effects::Level::site) {
    return fail(ErrorCode::usage, fmt::format("{} is not in the calibration", effect->name()),
                "only effects of the site can be added to a check; for others calibrate again");
  }
  out.needs_angles = true;
  out.effects.push_back(effect);
  for (std::size_t j = 0; j < effect->coefficients().size(); ++j) {
    out.nuisance.push_back(slots.effects() + static_cast<Eigen::Index>(values.size()));
    values.push_back(0);
  }
  return {};
}

}  // namespace

Result<FixedCalibration> fixed_calibration(const calibration::Calibration& c,
                                           const std::vector<effects::EffectPtr>& added) {
  FixedCalibration out;
  const fit::joint::FixedSlots slots{static_cast<int>(c.sensors.size())};
  fix_sensors(slots, out);
  std::vector<double> values;
  std::vector<Eigen::Index> rows;
  Eigen::Index row = 0;
  for (const calibration::CalibratedEffect& e : c.effects) {
    const auto effect = effects::library::make_effect(e.effect, static_cast<int>(c.sensors.size()));
    if (!effect) return tl::unexpected(effect.error());
    // Another table is another table: its own errors are no part of what is under test.
    if ((*effect)->level() != effects::Level::table) fix_effect(slots, e, *effect, row, values, rows, out);
    row += static_cast<Eigen::Index>(e.coefficients.size());
  }
  for (const effects::EffectPtr& effect : added) {
    const auto same = [&](const calibration::CalibratedEffect& e) { return e.effect == effect->spec(); };
    if (std::any_of(c.effects.begin(), c.effects.end(), same)) continue;
    if (auto ok = add_site_effect(slots, effect, values, out); !ok) return tl::unexpected(ok.error());
  }
  out.coefficients =
      Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
  std::vector<Eigen::Index> under_test(static_cast<std::size_t>(slots.sensor_block()));
  std::iota(under_test.begin(), under_test.end(), 0);
  for (const Eigen::Index coefficient : rows) under_test.push_back(slots.sensor_block() + coefficient);
  out.covariance = calibration::full_covariance(c)(under_test, under_test);
  return out;
}

}  // namespace mgtd::calib::validity
