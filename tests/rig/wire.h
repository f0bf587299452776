// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <random>
#include <string>

/// The cable: bytes leave at the baud rate, and some faults live here. Pure.
namespace mgtd::rig {

class Wire {
 public:
  Wire(int baud, std::uint64_t seed) : bytes_per_s_(baud / 10.0), random_(seed) {}

  /// What the instrument said; waits for its turn on the line.
  void push(std::string bytes);
  /// What has left the line by now.
  [[nodiscard]] std::string pull(double now_s);
  void garbage();
  void set_torn(bool torn) { torn_ = torn; }
  void clear() { queue_.clear(); }

 private:
  double bytes_per_s_;
  std::mt19937_64 random_;
  std::string queue_;
  double last_s_{0}, credit_{0};
  bool torn_{false};
};

}  // namespace mgtd::rig
