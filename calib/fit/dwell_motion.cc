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

constexpr double kGross = 25;  ///< times the square of a usual move

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

/// Median square of the moves from each pose to the next.
double usual_square_nT2(const PoseTable& table, bool vector) {
  std::vector<double> squares;
  for (std::size_t k = 1; k < table.poses.size(); ++k)
    if (const auto move = move_between(table.poses[k - 1], table.poses[k], vector))
      squares.push_back(move->square_nT2);
  return stats::median(std::move(squares));
}

/// A gross reading of the reference makes two moves that cancel: both are far beyond the usual one and beyond
/// the move past it. At either end of the run one move tells, where the next is a usual one.
bool is_gross(const PoseTable& table, std::size_t k, bool vector, double usual_nT2) {
  const std::size_t last = table.poses.size() - 1;
  const bool end = k == 0 || k == last;
  const Pose &here = table.poses[k], &before = table.poses[end ? (k == 0 ? 1 : last - 1) : k - 1],
             &after = table.poses[end ? (k == 0 ? 2 : last - 2) : k + 1];
  const auto to = move_between(before, here, vector), on = end ? to : move_between(here, after, vector),
             past = move_between(before, after, vector);
  if (!to || !on || !past) return false;
  const double limit = kGross * std::max({usual_nT2, past->square_nT2, past->noise_nT2});
  return std::min(to->square_nT2, on->square_nT2) > limit;
}

std::optional<double> mean_square_nT2(const PoseTable& table, bool vector) {
  if (table.poses.size() < kFewestPairs) return std::nullopt;
  const double usual_nT2 = usual_square_nT2(table, vector);
  std::vector<bool> gross;
  for (std::size_t k = 0; k < table.poses.size(); ++k) gross.push_back(is_gross(table, k, vector, usual_nT2));
  double sum = 0;
  std::size_t pairs = 0;
  for (std::size_t k = 1; k < table.poses.size(); ++k) {
    const Pose &from = table.poses[k - 1], &to = table.poses[k];
    if (gross[k - 1] || gross[k] || !from.t_s || !to.t_s || !from.dwell_s || !to.dwell_s) continue;
    const double gap_s = *to.t_s - *from.t_s;
    if (!(gap_s > 0) || gap_s > kLongestGap_s) continue;
    const auto move = move_between(from, to, vector);
    if (!move) continue;
    const double dwells_s2 = (std::pow(*from.dwell_s, 2) + std::pow(*to.dwell_s, 2)) / 2;
    sum += (move->square_nT2 - move->noise_nT2) / (gap_s * gap_s) * dwells_s2 / 12;
    ++pairs;
  }
  if (pairs < kFewestPairs) return std::nullopt;
  return std::max(0.0, sum / static_cast<double>(pairs));
}

}  // namespace

std::optional<DwellMotion> dwell_motion(const PoseTable& table) {
  for (const bool vector : {true, false})
    if (const auto square = mean_square_nT2(table, vector)) return DwellMotion{std::sqrt(*square), vector};
  return std::nullopt;
}

}  // namespace mgtd::calib::fit
