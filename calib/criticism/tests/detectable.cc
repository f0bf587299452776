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
      const double left = h.combine.col(j).dot(s.gram * h.combine.col(j));
      const double value = kSeen / std::sqrt(left);
      if (!(value > out.value) || !std::isfinite(value)) continue;
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
