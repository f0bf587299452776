// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/detectable.h"

#include <cmath>

namespace mgtd::calib::criticism::tests {

Detectable detectable_of(const CandidateEffect& candidate_effect, const Signature& s) {
  Detectable out{.effect = candidate_effect.name};
  for (const Hypothesis& h : candidate_effect.hypotheses) {
    if (candidate_effect.level == effects::Level::axis ? h.axes != 1
                                                       : &h != &candidate_effect.hypotheses.front())
      continue;
    for (Eigen::Index j = 0; j < h.combine.cols(); ++j) {
      const auto t = h.combine.col(j);
      const double whole = t.cwiseAbs2().dot(s.norms().cwiseAbs2()), left = t.dot(s.gram() * t);
      if (!(whole > 0)) continue;
      const bool absorbed = left < s.absorbed() * s.absorbed() * whole;
      const double value = absorbed ? kAtNoSize : kSeen / std::sqrt(left);
      if (!(value > out.value)) continue;
      Eigen::Index of = 0;
      h.combine.col(j).maxCoeff(&of);
      out.value = value;
      out.where = h.names[static_cast<std::size_t>(j)];
      out.unit = candidate_effect.variants.front()->coefficients()[static_cast<std::size_t>(of)].unit;
    }
  }
  return out;
}

}  // namespace mgtd::calib::criticism::tests
