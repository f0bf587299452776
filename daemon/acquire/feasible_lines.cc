// SPDX-License-Identifier: Apache-2.0
#include "daemon/acquire/feasible_lines.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mgtd::daemon::acquire {

void FeasibleLines::start(double k, Range t_s, Range period_s) {
  k0_ = k;
  base_ = {t_s.most, (period_s.least + period_s.most) / 2};
  const double depth_s = t_s.least - t_s.most, half_s = (period_s.most - period_s.least) / 2;
  corners_ = {{depth_s, -half_s}, {0, -half_s}, {0, half_s}, {depth_s, half_s}};
}

void FeasibleLines::clip(const Polygon& from, double a, double b, double most, Polygon& to) {
  to.clear();
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Corner &p = from[i], &q = from[(i + 1) % from.size()];
    const double over_p = a * p.t_s + b * p.period_s - most, over_q = a * q.t_s + b * q.period_s - most;
    if (over_p <= 0) to.push_back(p);
    if ((over_p < 0 && over_q > 0) || (over_p > 0 && over_q < 0)) {
      const double u = over_p / (over_p - over_q);
      to.push_back({p.t_s + u * (q.t_s - p.t_s), p.period_s + u * (q.period_s - p.period_s)});
    }
  }
}

bool FeasibleLines::cut(double k, double t_s, double sign) {
  const double a = sign, b = sign * (k - k0_), most = sign * (t_s - base_time(k));
  const auto beyond = [&](const Corner& c) { return a * c.t_s + b * c.period_s > most; };
  if (std::none_of(corners_.begin(), corners_.end(), beyond)) return true;
  clip(corners_, a, b, most, scratch_);
  if (scratch_.size() < 3) return false;
  std::swap(corners_, scratch_);
  simplify();
  return true;
}

/// The offsets are those at k from now on, and the base line goes through the middle of the set.
void FeasibleLines::shift(double k) {
  base_.t_s = base_time(k);
  for (Corner& c : corners_) c.t_s += c.period_s * (k - k0_);
  k0_ = k;
  Corner middle;
  for (const Corner& c : corners_) {
    middle.t_s += c.t_s / static_cast<double>(corners_.size());
    middle.period_s += c.period_s / static_cast<double>(corners_.size());
  }
  base_.t_s += middle.t_s;
  base_.period_s += middle.period_s;
  for (Corner& c : corners_) {
    c.t_s -= middle.t_s;
    c.period_s -= middle.period_s;
  }
}

/// The Minkowski sum with a segment of periods: the corners above the two of least and greatest offset move
/// up, those below move down, those two become two each. Widened before the time passes, the set covers a
/// change at any moment of it.
void FeasibleLines::allow_wander(double k, double by_s) {
  const auto less = [](const Corner& p, const Corner& q) { return p.t_s < q.t_s; };
  const auto [first, last] = std::minmax_element(corners_.begin(), corners_.end(), less);
  const auto left = static_cast<std::size_t>(first - corners_.begin());
  const auto right = static_cast<std::size_t>(last - corners_.begin());
  const std::size_t n = corners_.size();
  scratch_.clear();
  for (std::size_t i = left;; i = (i + 1) % n) {  // along the lower side, to the right
    scratch_.push_back({corners_[i].t_s, corners_[i].period_s - by_s});
    if (i == right) break;
  }
  for (std::size_t i = right;; i = (i + 1) % n) {
    scratch_.push_back({corners_[i].t_s, corners_[i].period_s + by_s});
    if (i == left) break;
  }
  std::swap(corners_, scratch_);
  shift(k);
  simplify();
}

/// Gives up the edge whose neighbours, prolonged until they meet, enclose the least area more.
void FeasibleLines::simplify() {
  while (corners_.size() > kMost) {
    const std::size_t n = corners_.size();
    double least = std::numeric_limits<double>::max();
    std::size_t edge = n;
    Corner meet;
    for (std::size_t i = 0; i < n; ++i) {
      const Corner &o = corners_[(i + n - 1) % n], &p = corners_[i], &q = corners_[(i + 1) % n],
                   &r = corners_[(i + 2) % n];
      const double ax = p.t_s - o.t_s, ay = p.period_s - o.period_s, bx = q.t_s - r.t_s,
                   by = q.period_s - r.period_s, cx = q.t_s - p.t_s, cy = q.period_s - p.period_s;
      const double turn =
          ax * by - ay * bx;  // the two meet beyond the edge when they turn by less than 180 deg
      const double u = (cx * by - cy * bx) / turn;
      const double area = std::abs(u * (ax * cy - ay * cx));
      const double v = (cx * ay - cy * ax) / turn;
      if (!(turn < 0 ? u >= 0 && v >= 0 : false) || !(area < least)) continue;
      least = area;
      edge = i;
      meet = {p.t_s + u * ax, p.period_s + u * ay};
    }
    if (edge == n) return;
    const std::size_t next = (edge + 1) % n;
    corners_[edge] = meet;
    corners_.erase(corners_.begin() + static_cast<std::ptrdiff_t>(next));
  }
}

FeasibleLines::Range FeasibleLines::time(double k) const {
  Range out{std::numeric_limits<double>::max(), std::numeric_limits<double>::lowest()};
  for (const Corner& c : corners_) {
    const double t_s = c.t_s + c.period_s * (k - k0_);
    out = {std::min(out.least, t_s), std::max(out.most, t_s)};
  }
  const double base_s = base_time(k);
  return {out.least + base_s, out.most + base_s};
}

FeasibleLines::Range FeasibleLines::period() const {
  Range out{std::numeric_limits<double>::max(), std::numeric_limits<double>::lowest()};
  for (const Corner& c : corners_) out = {std::min(out.least, c.period_s), std::max(out.most, c.period_s)};
  return {out.least + base_.period_s, out.most + base_.period_s};
}

FeasibleLines::Line FeasibleLines::highest_at(double k, Range period_s) const {
  Polygon some, within;
  clip(corners_, 0, 1, period_s.most - base_.period_s, some);
  clip(some, 0, -1, base_.period_s - period_s.least, within);
  const Polygon& among = within.empty() ? corners_ : within;
  const auto height = [&](const Corner& c) { return c.t_s + c.period_s * (k - k0_); };
  const auto best = std::max_element(among.begin(), among.end(),
                                     [&](const Corner& p, const Corner& q) { return height(p) < height(q); });
  return {base_time(k) + height(*best), base_.period_s + best->period_s};
}

}  // namespace mgtd::daemon::acquire
