// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <utility>

/// One simulated instrument, seen from its serial connector: bytes and time in, bytes out. All times are
/// simulated seconds since the rig was switched on and never go back.
namespace mgtd::rig {

class Instrument {
 public:
  virtual ~Instrument() = default;
  /// Bytes from the host.
  virtual void receive(std::string_view bytes, double now_s) = 0;
  /// Lets the instrument do what is due up to now.
  virtual void advance(double now_s) = 0;
  /// When advance() has something to do next; for the executor's timer.
  [[nodiscard]] virtual double next_s() const = 0;
  [[nodiscard]] virtual int baud() const = 0;
  [[nodiscard]] std::string take_output() { return std::exchange(output_, {}); }

  /// Faults that the instrument itself can have. A silent one neither speaks nor listens; a frozen one
  /// repeats its last values.
  virtual void set_silent(bool silent) { silent_ = silent; }
  virtual void set_frozen(bool frozen) { frozen_ = frozen; }

 protected:
  void put(std::string_view bytes) {
    if (!silent_) output_ += bytes;
  }
  bool silent_{false};
  bool frozen_{false};

 private:
  std::string output_;
};

}  // namespace mgtd::rig
