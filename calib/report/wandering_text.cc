// SPDX-License-Identifier: Apache-2.0
#include "calib/report/wandering_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace mgtd::calib::report {

std::string wandering_text(const fit::joint::WanderingEstimate& w) {
  if (!w.any()) return {};
  Eigen::Index most = 0;
  w.nT_per_sqrt_h.maxCoeff(&most);
  return fmt::format(
      "slow wandering of {}, up to {:.2g} +- {:.1g} nT per root hour (s{}.{})",
      w.where.front() == "all" ? "all offsets" : fmt::format("the offsets of {}", fmt::join(w.where, ", ")),
      w.nT_per_sqrt_h[most], w.sd[most], most / 3 + 1, "xyz"[most % 3]);
}

}  // namespace mgtd::calib::report
