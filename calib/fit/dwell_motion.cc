// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/dwell_motion.h"

#include <algorithm>
#include <cmath>

#include "calib/fit/site_difference.h"

namespace mgtd::calib::fit {
namespace {

constexpr double kLongestGap_s = 60;
constexpr int kFewestPairs = 12;

/// Square of the move of one component between two poses, less what the noise of the reference makes of it.
std::optional<double> squared_move_nT2(const Pose& from, const Pose& to, bool vector) {
  if (vector) {
    if (!from.ref_nT || !to.ref_nT || !from.angles() || !to.angles()) return std::nullopt;
    const double noise = std::pow(reference_sd_nT(from), 2) + std::pow(reference_sd_nT(to), 2);
    return (*to.ref_nT - *from.ref_nT).squaredNorm() / 3 - noise;
  }
  if (!from.f_nT || !to.f_nT) return std::nullopt;
  const double noise = std::pow(from.f_sd_nT.value_or(kDefaultScalarSd_nT), 2) +
                       std::pow(to.f_sd_nT.value_or(kDefaultScalarSd_nT), 2);
  return std::pow(*to.f_nT - *from.f_nT, 2) - noise;
}

std::optional<double> mean_square_nT2(const PoseTable& table, bool vector) {
  double sum = 0;
  int pairs = 0;
  for (std::size_t k = 1; k < table.poses.size(); ++k) {
    const Pose &from = table.poses[k - 1], &to = table.poses[k];
    if (!from.t_s || !to.t_s || !from.dwell_s || !to.dwell_s) continue;
    const double gap_s = *to.t_s - *from.t_s;
    if (!(gap_s > 0) || gap_s > kLongestGap_s) continue;
    const auto square = squared_move_nT2(from, to, vector);
    if (!square) continue;
    const double dwells_s2 = (std::pow(*from.dwell_s, 2) + std::pow(*to.dwell_s, 2)) / 2;
    sum += *square / (gap_s * gap_s) * dwells_s2 / 12;
    ++pairs;
  }
  return pairs < kFewestPairs ? std::nullopt : std::optional(std::max(0.0, sum / pairs));
}

}  // namespace

std::optional<DwellMotion> dwell_motion(const PoseTable& table) {
  for (const bool vector : {true, false})
    if (const auto square = mean_square_nT2(table, vector)) return DwellMotion{std::sqrt(*square), vector};
  return std::nullopt;
}

}  // namespace mgtd::calib::fit
