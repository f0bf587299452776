// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "calib/criticism/tests/comparison.h"
#include "calib/criticism/tests/residual_columns.h"
#include "calib/report/figures/figure.h"

/// panel_figures() draws nine panels of what a model leaves: against time, azimuth, temperature and the
/// direction of the field; its distribution and its memory; the parts of it that are blind to angles, to
/// sensors and to gradients. There is one more panel for every extra column that it follows.
namespace mgtd::calib::report {

/// Combinations of closure that a figure shows.
inline constexpr std::size_t kMostClosures = 4;

/// One model of a run.
struct PanelModel {
  const criticism::tests::Comparison& comparison;
  const criticism::tests::ResidualColumns& left;
};

/// `after`: the same poses with effects in the model, on equal axes; null: none were added. Panels whose
/// quantity was not measured are left out.
[[nodiscard]] std::vector<figures::Figure> panel_figures(const PanelModel& before, const PanelModel* after);

}  // namespace mgtd::calib::report
