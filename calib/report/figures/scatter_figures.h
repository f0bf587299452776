// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "calib/report/figures/figure.h"

/// These figures show all residuals together in three ways: whether they are normal, whether those of one
/// pose depend on the poses before, and whether they follow one effect.
namespace mgtd::calib::report::figures {

/// Residuals in units of their noise, in order, against the normal quantiles of their ranks, with the
/// envelope within which all of them lie in 95 of 100 runs of pure noise.
struct QqView {
  std::size_t n{0};  ///< of all; the points may be some of them
  std::vector<double> quantile{}, residual{}, low{}, high{};
};
struct QqValues {
  QqView before{}, after{};  ///< after: empty where nothing was added
  std::size_t left_out{0};   ///< readings that the fit left out; they are not among these
};
[[nodiscard]] Figure qq_figure(const QqValues& values);

/// Correlation of the residuals of one sensor with those some poses earlier, lags 1, 2, ...; of pure noise,
/// 95 of 100 lie within `bound`.
struct AutocorrelationValues {
  std::vector<std::string> sensors{};
  std::vector<std::vector<double>> before{}, after{};  ///< by sensor, by lag from 1
  double bound{0};
  double rho{0};  ///< that the tests allow for
};
[[nodiscard]] Figure autocorrelation_figure(const AutocorrelationValues& values);

/// Added-variable plot of one candidate: what it would make of each pose against what is left there,
/// everything else of the model taken out of both. The slope is the coefficient.
struct EvidenceValues {
  std::string name{"evidence"};  ///< of the figure
  std::string effect{}, where{};
  std::string x_label{}, y_label{"residual, nT"};
  std::string slope_text{};  ///< "3.00 ± 0.08 nT/°C"
  double slope{0}, slope_sd{0};
  std::vector<double> x{}, y{};
  std::vector<int> poses{};
  double largest_share{0};  ///< of the evidence, of one pose
};
[[nodiscard]] Figure evidence_figure(const EvidenceValues& values);

}  // namespace mgtd::calib::report::figures
