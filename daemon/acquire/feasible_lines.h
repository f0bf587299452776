// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <optional>
#include <vector>

/// FeasibleLines holds the straight lines t(k) = t0 + b k, sample time against sample number, that no
/// observation excludes: a convex polygon in the plane of offset and period. Each observation is a
/// half-plane: t(k) <= t, or t(k) >= t. Whatever the polygon says of a sample's time is a bound, not an
/// estimate (set-membership estimation: M. Milanese, A. Vicino, Automatica 27 (1991) 997).
///
/// The period may wander: allow_wander() widens the set by so much. At most kMost corners are kept; beyond
/// that an edge is given up, so that the set grows and stays a bound. Storage and time are bounded.
///
/// Seconds; k in samples. Does not judge whether an observation is to be believed.
namespace mgtd::daemon::acquire {

class FeasibleLines {
 public:
  static constexpr std::size_t kMost = 24;

  struct Range {
    double least{0}, most{0};
  };
  struct Line {
    double t_s{0};  ///< at the number asked for
    double period_s{0};
  };

  FeasibleLines() { corners_.reserve(2 * kMost); }

  /// At number k between least_s and most_s, with a period between the two.
  void start(double k, Range t_s, Range period_s);
  /// False: no line of the set is so; the set stays as it was.
  [[nodiscard]] bool not_above(double k, double t_s) { return cut(k, t_s, 1); }
  [[nodiscard]] bool not_below(double k, double t_s) { return cut(k, t_s, -1); }
  /// From here on the period may have changed by so much, either way; offsets count from k now.
  void allow_wander(double k, double by_s);

  [[nodiscard]] Range time(double k) const;
  [[nodiscard]] Range period() const;
  /// Of the lines with a period in the range, or of all where none has one: the one that is highest at k.
  [[nodiscard]] Line highest_at(double k, Range period_s) const;

 private:
  struct Corner {
    double t_s{0}, period_s{0};  ///< less those of the base line
  };
  using Polygon = std::vector<Corner>;

  [[nodiscard]] double base_time(double k) const { return base_.t_s + base_.period_s * (k - k0_); }
  [[nodiscard]] bool cut(double k, double t_s, double sign);
  /// What of `from` has a t + b period <= most.
  static void clip(const Polygon& from, double a, double b, double most, Polygon& to);
  void shift(double k);
  void simplify();

  double k0_{0};  ///< where the corners' offsets count
  Line base_;
  Polygon corners_, scratch_;  ///< counter-clockwise, offset to the right, period upwards
};

}  // namespace mgtd::daemon::acquire
