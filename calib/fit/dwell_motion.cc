// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/dwell_motion.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "calib/fit/site_difference.h"
#include "calib/stats/median.h"

namespace mgtd::calib::fit {
namespace {

constexpr double kLongestGap_s = 60;
constexpr std::size_t kFewestPairs = 12;

constexpr double kGross = 25;  ///< times the median square

/// Squares of a component, of its move between two poses and of what the noise of the reference makes of
/// that.
struct Move {
  double square_nT2, noise_nT2;
};

std::optional<Move> move_between(const Pose& from, const Pose& to, bool vector) {
  if (vector) {
    if (!from.ref_nT || !to.ref_nT || !from.angles() || !to.angles()) return std::nullopt;
    return Move{(*to.ref_nT - *from.ref_nT).squaredNorm() / 3,
                std::pow(reference_sd_nT(from), 2) + std::pow(reference_sd_nT(to), 2)};
  }
  if (!from.f_nT || !to.f_nT) return std::nullopt;
  return Move{std::pow(*to.f_nT - *from.f_nT, 2),
              std::pow(scalar_sd_nT(from), 2) + std::pow(scalar_sd_nT(to), 2)};
}

/// A gross reading of the reference makes two moves that are none.
double mean_without_gross(const std::vector<Move>& moves) {
  std::vector<double> squares;
  for (const Move& move : moves) squares.push_back(move.square_nT2);
  const double limit = kGross * stats::median(squares);
  double sum = 0;
  int count = 0;
  for (const Move& move : moves)
    if (move.square_nT2 <= limit) sum += move.square_nT2 - move.noise_nT2, ++count;
  return std::max(0.0, sum / count);
}

std::optional<double> mean_square_nT2(const PoseTable& table, bool vector) {
  std::vector<Move> in_dwells;
  for (std::size_t k = 1; k < table.poses.size(); ++k) {
    const Pose &from = table.poses[k - 1], &to = table.poses[k];
    if (!from.t_s || !to.t_s || !from.dwell_s || !to.dwell_s) continue;
    const double gap_s = *to.t_s - *from.t_s;
    if (!(gap_s > 0) || gap_s > kLongestGap_s) continue;
    const auto move = move_between(from, to, vector);
    if (!move) continue;
    const double dwells_s2 = (std::pow(*from.dwell_s, 2) + std::pow(*to.dwell_s, 2)) / 2;
    const double in_dwell = dwells_s2 / (12 * gap_s * gap_s);
    in_dwells.push_back({move->square_nT2 * in_dwell, move->noise_nT2 * in_dwell});
  }
  if (in_dwells.size() < kFewestPairs) return std::nullopt;
  return mean_without_gross(in_dwells);
}

}  // namespace

std::optional<DwellMotion> dwell_motion(const PoseTable& table) {
  for (const bool vector : {true, false})
    if (const auto square = mean_square_nT2(table, vector)) return DwellMotion{std::sqrt(*square), vector};
  return std::nullopt;
}

}  // namespace mgtd::calib::fit
