// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <random>

/// This moves one table axis: trapezoidal moves in indicated degrees, and a true angle that is never quite
/// the indicated one. Every move, however short, ends with a fresh error; on the way the old one turns into
/// the new one.
namespace mgtd::rig {

class AxisMotion {
 public:
  AxisMotion(double velocity_deg_per_s, double acceleration_deg_per_s2, double accuracy_sd_deg)
      : velocity_(velocity_deg_per_s), acceleration_(acceleration_deg_per_s2), accuracy_(accuracy_sd_deg) {}

  /// Of the moves that begin from now on.
  void set_velocity(double deg_per_s) { velocity_ = deg_per_s; }
  [[nodiscard]] double velocity() const { return velocity_; }
  void move_to(double target_deg, double now_s, std::mt19937_64& random);
  /// Stands at once.
  void halt(double now_s);
  /// Sticks where it is, in the middle of a move that it never ends until released (a jammed table).
  void jam(double now_s);
  void release(double now_s);
  /// Turns on at its velocity, beside every move, until it no longer does: then it stands at once.
  void run_away(double now_s);
  void catch_up(double now_s);

  [[nodiscard]] double indicated_deg(double t_s) const;
  [[nodiscard]] double true_deg(double t_s) const;
  [[nodiscard]] bool moving(double t_s) const {
    return ran_away_s_ || (jammed_ ? jammed_at_s_ : t_s) < end_s_;
  }
  [[nodiscard]] double end_s() const { return end_s_; }
  /// +1 or -1, the direction of the last move; 0 before the first.
  [[nodiscard]] int sense() const { return sense_; }

 private:
  [[nodiscard]] double progress(double t_s) const;  ///< 0 .. 1 of the way of the present move
  [[nodiscard]] double settled(double t_s) const;   ///< 0 .. 1 from the old error to the new one

  double velocity_, acceleration_, accuracy_;
  double from_deg_{0}, to_deg_{0}, start_s_{0}, end_s_{0};
  double move_velocity_{1};
  double from_error_deg_{0}, to_error_deg_{0};
  int sense_{0};
  bool jammed_{false};
  double jammed_at_s_{0};
  std::optional<double> ran_away_s_;
};

}  // namespace mgtd::rig
