// SPDX-License-Identifier: Apache-2.0
#include "calib/report/formula_figure.h"

#include <fmt/format.h>

#include <algorithm>

#include "calib/report/figures/scatter_figures.h"

namespace mgtd::calib::report {
namespace {

/// "k +3.00 ± 0.08 nT/A"; of several coefficients the first two.
std::string fitted_text(const std::vector<calibration::EffectCoefficient>& coefficients) {
  constexpr std::size_t kShown = 2;
  std::string out;
  for (std::size_t i = 0; i < std::min(kShown, coefficients.size()); ++i) {
    const calibration::EffectCoefficient& c = coefficients[i];
    out += fmt::format("{}{} {:+.4g} ± {:.2g} {}", out.empty() ? "" : ", ", c.name, c.value, c.sd, c.unit);
  }
  return coefficients.size() > kShown ? out + ", ..." : out;
}

}  // namespace

figures::Figure formula_figure(const criticism::tests::FormulaExamination& x) {
  figures::EvidenceValues v{.name = "signature",
                            .effect = x.name,
                            .where = x.where,
                            .x_label = "what the formula makes of the pose, in units of the noise",
                            .y_label = "left there, in units of the noise",
                            .slope_text = fitted_text(x.coefficients),
                            .slope = x.signature.slope,
                            .slope_sd = x.signature.slope_sd,
                            .x = x.signature.x,
                            .y = x.signature.y,
                            .poses = x.signature.pose};
  if (!x.signature.share.empty())
    v.largest_share = *std::max_element(x.signature.share.begin(), x.signature.share.end());
  return figures::evidence_figure(v);
}

}  // namespace mgtd::calib::report
