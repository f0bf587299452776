// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "calib/criticism/tests/score.h"

/// Residual maps test whether the residual depends on anything that was recorded, for effects that are in no
/// library. A map is a set of smooth functions of one covariate, free in every channel (or in the site's
/// field); its score test says whether the residual depends on that covariate.
///
///     time            8 cosines a channel          direction        monomials of degree 2 to 4 of the field
///     azimuth         4 harmonics a channel                         direction at the sensor, a channel
///     own reading     polynomials of degree 2 to 6 of the axis' part of the field, a channel
///     temperature     cubic of the sensor's own    previous pose    last reading of the sensor, a channel
///     own reading x time                       the axis' part of the field times 4 cosines, a channel
///     own reading x temperature                the same times the cubic of the sensor's own, a channel
///     mount           a level for each mounting    site field       8 cosines of time, 3 components
///     site gradient   8 cosines, 5 components      site map         gradient and curvature, constant
///     <column>        quadratic of every extra numeric column, a channel
namespace mgtd::calib::criticism::tests {

struct MapScore {
  std::string map{};
  std::string where{};  ///< of the hypothesis that shows it best
  double S{0};
  int k{0};
  double log10_p{0};                 ///< of the map, its hypotheses counted
  std::vector<double> by_channel{};  ///< log10 p of each channel alone; 0 where it has none
  Eigen::VectorXd fit{};             ///< the residual that the map explains, rows as Residual::value()
};

/// Of the maps that the poses can feed, the smallest p first. One map is held at a time.
[[nodiscard]] std::vector<MapScore> score_maps(const fit::joint::JointProblem& problem,
                                               const fit::joint::JointState& state, const Residual& residual,
                                               const NoiseReference& noise);

}  // namespace mgtd::calib::criticism::tests
