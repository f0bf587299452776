// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "calib/report/figures/figure.h"
#include "calib/report/figures/plot.h"

/// residual_figure() draws what the model leaves against something that was recorded. Beside it, on equal
/// axes, stands what is left with the effects in the model. Over the points stand the means of equally filled
/// bins with two standard errors, at the mean of what lies in each bin.
namespace mgtd::calib::report::figures {

struct ResidualView {
  std::vector<Series> series{};  ///< by pose; all with the same x
  std::string p_text{};          ///< "p = 2e-64", of no dependence
};

struct ResidualValues {
  std::string name{}, title{};
  std::string x_label{}, y_label{};  ///< with units
  bool angle_deg{false};             ///< x is an angle
  std::string what{};                ///< a sentence: what the residual is, what it is blind to
  ResidualView before{};
  std::string before_title{"model as fitted"}, after_title{"with the effects"};
  ResidualView after{};  ///< empty: the model is complete, one plot
  bool stands_out{false};
};

[[nodiscard]] Figure residual_figure(const ResidualValues& values);

}  // namespace mgtd::calib::report::figures
