// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <deque>
#include <random>
#include <string>

#include "tests/rig/instrument.h"

/// A Wire is a cable: ten bit times a byte, one byte after the other, and the faults that live in cables.
/// Pure.
namespace mgtd::rig {

class Wire {
 public:
  Wire(int baud, std::uint64_t seed) : byte_s_(10.0 / baud), random_(seed) {}

  /// What the instrument says; waits for its turn on the line. Utterances come in the order of their times.
  void push(Utterance said);
  /// The bytes whose last bit has arrived by now.
  [[nodiscard]] std::string pull(double now_s);
  /// What has arrived is handed over when a timer of this period ticks; 0: at once.
  void set_delivery(double step_s, double phase_s) {
    step_s_ = step_s;
    phase_s_ = phase_s;
  }
  /// 200 random bytes, after what is on the line.
  void garbage(double now_s);
  /// One byte in a hundred gets lost.
  void set_torn(bool torn) { torn_ = torn; }
  /// Every other line loses its second half.
  void set_half(bool half) { half_ = half; }
  /// Every line comes twice.
  void set_twice(bool twice) { twice_ = twice; }
  /// Every line arrives 0.4 to 2 s late, none before another that was said earlier.
  void set_late(bool late) { late_ = late; }
  /// A line and the next change places.
  void set_swapped(bool swapped);
  /// Nobody is at the other end: what is on the line is lost.
  void clear();

 private:
  struct Burst {
    double begin_s;  ///< of the first byte not yet pulled
    std::string bytes;
  };

  void carry(Utterance said);

  double byte_s_;
  std::mt19937_64 random_;
  std::deque<Burst> bursts_;
  double step_s_{0}, phase_s_{0};
  double free_s_{0};  ///< when the line has carried all that was pushed
  bool torn_{false}, half_{false}, twice_{false}, swapped_{false}, late_{false};
  std::uint64_t pushed_{0};
  std::string held_;  ///< waits for the line that goes before it
};

}  // namespace mgtd::rig
