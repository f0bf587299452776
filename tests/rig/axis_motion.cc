// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/axis_motion.h"

#include <algorithm>
#include <cmath>

namespace mgtd::rig {
namespace {

/// However short a move is, its servo takes this time to come to rest: nothing that has mass jumps.
constexpr double kShortest_s = 0.1;

/// Duration of a trapezoidal (or, when short, triangular) move.
double duration(double distance, double v, double a) {
  return distance < v * v / a ? 2 * std::sqrt(distance / a) : distance / v + v / a;
}

/// Distance covered after t of such a move.
double covered(double t, double distance, double v, double a) {
  const double whole = duration(distance, v, a);
  if (t >= whole) return distance;
  const double peak = std::min(v, std::sqrt(distance * a));
  const double ramp = peak / a;
  if (t < ramp) return 0.5 * a * t * t;
  if (t > whole - ramp) return distance - 0.5 * a * (whole - t) * (whole - t);
  return 0.5 * a * ramp * ramp + peak * (t - ramp);
}

}  // namespace

double AxisMotion::progress(double t_s) const {
  const double distance = std::abs(to_deg_ - from_deg_);
  if (distance == 0 || t_s >= end_s_) return 1;
  return covered(std::max(0.0, t_s - start_s_), distance, move_velocity_, acceleration_) / distance;
}

double AxisMotion::indicated_deg(double t_s) const {
  const double p = progress(jammed_ ? jammed_at_s_ : t_s);
  const double further_deg = ran_away_s_ ? velocity_ * std::max(0.0, t_s - *ran_away_s_) : 0;
  return from_deg_ + p * (to_deg_ - from_deg_) + further_deg;
}

/// Its first derivative is zero at both ends.
double AxisMotion::settled(double t_s) const {
  if (t_s >= end_s_) return 1;
  const double u = std::max(0.0, (t_s - start_s_) / (end_s_ - start_s_));
  return u * u * (3 - 2 * u);
}

double AxisMotion::true_deg(double t_s) const {
  const double share = settled(jammed_ ? jammed_at_s_ : t_s);
  return indicated_deg(t_s) + from_error_deg_ + share * (to_error_deg_ - from_error_deg_);
}

void AxisMotion::move_to(double target_deg, double now_s, std::mt19937_64& random) {
  const double error = true_deg(now_s) - indicated_deg(now_s);
  from_deg_ = indicated_deg(now_s);
  if (ran_away_s_) ran_away_s_ = now_s;
  from_error_deg_ = error;
  to_error_deg_ = accuracy_ > 0 ? accuracy_ * std::normal_distribution<double>()(random) : 0.0;
  to_deg_ = target_deg;
  if (to_deg_ != from_deg_) sense_ = to_deg_ > from_deg_ ? 1 : -1;
  move_velocity_ = velocity_;
  start_s_ = now_s;
  end_s_ =
      now_s + std::max(kShortest_s, duration(std::abs(to_deg_ - from_deg_), move_velocity_, acceleration_));
  if (jammed_) jammed_at_s_ = now_s;
}

void AxisMotion::halt(double now_s) {
  const double error = true_deg(now_s) - indicated_deg(now_s);
  from_deg_ = to_deg_ = indicated_deg(now_s);
  if (ran_away_s_) ran_away_s_ = now_s;
  from_error_deg_ = to_error_deg_ = error;
  start_s_ = end_s_ = now_s;
  jammed_at_s_ = now_s;
}

void AxisMotion::jam(double now_s) {
  if (!jammed_) jammed_at_s_ = now_s;
  jammed_ = true;
}

void AxisMotion::run_away(double now_s) {
  if (!ran_away_s_) ran_away_s_ = now_s;
}

void AxisMotion::catch_up(double now_s) {
  if (!ran_away_s_) return;
  halt(now_s);
  ran_away_s_.reset();
}

void AxisMotion::release(double now_s) {
  if (!jammed_) return;
  start_s_ += now_s - jammed_at_s_;
  end_s_ += now_s - jammed_at_s_;
  jammed_ = false;
}

}  // namespace mgtd::rig
