// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/formula_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calib/discovery/scalars.h"
#include "calib/effects/effect_context.h"

namespace mgtd::calib::discovery {
namespace {

constexpr Eigen::Index kMostPeriods = 400;

}  // namespace

std::string over_field(const std::string& reading) {
  return fmt::format("({}/{})", reading, number_text(effects::kReferenceField_nT));
}

std::string decay(double tau_s) { return fmt::format("exp(-3600*t_h/{})", number_text(tau_s)); }
std::vector<double> decays_s() { return ratios(80, 3000, 10); }

std::string lag(double tau_s, const std::string& of) {
  return fmt::format("lag{}_{}", std::max(1L, std::lround(tau_s)), of);
}
std::vector<double> lags_s() { return ratios(60, 2400, 10); }

Columns period(double hours, const std::string& times) {
  const std::string angle = fmt::format("(2*pi*t_h/{})", number_text(hours));
  return {times + "sin" + angle, times + "cos" + angle};
}
std::vector<double> periods_h(const LawInputs& inputs) {
  const Eigen::VectorXd t = inputs.name("t_h", 0);
  const double length_h = t.maxCoeff() - t.minCoeff();
  std::vector<double> out;
  if (!(length_h > 0)) return out;
  for (Eigen::Index j = std::min(t.size(), kMostPeriods); j > 0; --j)
    out.push_back(2 * length_h / static_cast<double>(j));
  return out;
}

std::vector<double> ratios(double first, double last, int n) {
  std::vector<double> out;
  for (int i = 0; i < n; ++i) out.push_back(first * std::pow(last / first, i / (n - 1.0)));
  return out;
}

}  // namespace mgtd::calib::discovery
