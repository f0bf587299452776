// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "calib/sensor/geometry.h"
#include "proto/epoch.h"
#include "proto/error.h"
#include "proto/health.h"
#include "proto/magnet_status.h"
#include "proto/slot.h"
#include "proto/time.h"

/// A WiringProbe finds out which sensor is on which arm: the operator holds a magnet to the end of one arm
/// after the other, and the sensor whose reading changes most is the one there. Nothing in the readings of a
/// uniform field says it, and two swapped cables turn the tensor into another that looks as good. An array
/// that is no cross has places instead of arms.
///
///     resting -> [ waiting -> leaving ] x N -> done          each with a limit of time: then "timed out"
///
/// A sensor is found when its reading is away from rest by kMoved_nT and by kRatio times more than any
/// other's, for kHeld_s on end. A dipole falls by 8 over a doubled distance, so a magnet nearer than half an
/// arm to one sensor leaves no doubt; where there is doubt, there is no answer. Arms that nobody answered
/// for, and a sensor that answered for two arms, are said to be open; nothing is guessed.
namespace mgtd::daemon::run {

class WiringProbe {
 public:
  static constexpr double kMoved_nT = 300, kRatio = 3;
  static constexpr double kRest_s = 2, kHeld_s = 0.5;
  static constexpr double kAnswer_s = 120;  ///< for each arm, and to come to rest; real time

  /// Hands keep their own time: with a clock `speed_up` times faster than real the limits are so much longer.
  explicit WiringProbe(Instant begin, double speed_up = 1, const calib::sensor::Geometry& array = {});

  void add(const Epoch& epoch);
  void advance(Instant now);
  void stop();
  [[nodiscard]] bool ended() const { return ended_.has_value(); }
  [[nodiscard]] MagnetStatus status() const;

 private:
  enum class Phase { resting, waiting, leaving };
  using Readings = PerSensor<Eigen::Vector3d>;
  struct Change {
    std::size_t sensor{0};  ///< that moved most
    double most_nT{0}, second_nT{0};
  };

  void enter(Phase phase, Instant now);
  void rest(const Epoch& epoch);
  void wait(const Epoch& epoch);
  void leave(const Epoch& epoch);
  [[nodiscard]] Change change(const Epoch& epoch) const;
  [[nodiscard]] std::string prompt() const;

  PerSensor<std::string> places_;  ///< "+X" of an arm of the cross, "0.2, 0.2, -0.2 m" of another array
  bool arms_;                      ///< the array is the cross
  double answer_s_;
  Phase phase_{Phase::resting};
  Instant entered_;
  std::optional<MagnetEnd> ended_;
  std::size_t arm_{0};                           ///< whose turn it is
  int asked_{0};                                 ///< arms the operator was asked for
  PerSensor<std::optional<std::size_t>> found_;  ///< sensor by arm

  Readings at_rest_;            ///< mean
  std::optional<Epoch> first_;  ///< of the time without a magnet that is under way
  Readings sum_;
  double count_{0};
  std::optional<Instant> since_;  ///< the same sensor has moved most
  std::size_t moving_{0};
  bool doubtful_{false};  ///< something moves, but not one sensor alone
};

/// All sensors speak; otherwise an arm would wait for one that cannot answer. One sensor alone cannot be
/// exchanged.
[[nodiscard]] Result<void> ready_for_magnet(const std::vector<std::pair<Slot, LinkHealth>>& links);

}  // namespace mgtd::daemon::run
