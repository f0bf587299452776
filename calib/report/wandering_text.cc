// SPDX-License-Identifier: Apache-2.0
#include "calib/report/wandering_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace mgtd::calib::report {
namespace {

std::string rate_with_sd(double value, double sd) {
  return value < 10 ? fmt::format("{:.2g} +- {:.1g}", value, sd) : fmt::format("{:.0f} +- {:.0f}", value, sd);
}

}  // namespace

std::string wandering_text(const fit::joint::WanderingEstimate& w) {
  if (!w.any()) return {};
  const bool walks = w.spectrum == fit::joint::SlowSpectrum::walk;
  Eigen::Index most = 0;
  w.size.maxCoeff(&most);
  const double unit = walks ? 1 : 1000;  // nT or pT
  return fmt::format(
      "{} of {}, up to {} {} (s{}.{})", walks ? "slow wandering" : "1/f noise",
      w.where.front() == "all" ? "all offsets" : fmt::format("the offsets of {}", fmt::join(w.where, ", ")),
      rate_with_sd(unit * w.size[most], unit * w.sd[most]),
      walks ? "nT per root hour" : "pT/sqrt(Hz) at 1 Hz", most / 3 + 1, "xyz"[most % 3]);
}

}  // namespace mgtd::calib::report
