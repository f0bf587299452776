// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// An Instrument is one simulated instrument, seen from its serial connector: bytes and time come in, bytes
/// go out. All times are simulated seconds since the rig was switched on and never go back.
namespace mgtd::rig {

/// What an instrument says, and the moment it begins to.
struct Utterance {
  double at_s{0};
  std::string bytes;
};

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

  /// What was said since the last call, one after the other; the cable wants the times, most tests do not.
  [[nodiscard]] std::vector<Utterance> take_utterances() { return std::exchange(said_, {}); }
  [[nodiscard]] std::string take_output() {
    std::string out;
    for (const Utterance& u : take_utterances()) out += u.bytes;
    return out;
  }

  /// Faults that the instrument itself can have. A silent one neither speaks nor listens; a mute one listens
  /// and obeys; a frozen one repeats its last values; a saturated one is at the end of its range.
  virtual void set_silent(bool silent) { silent_ = silent; }
  void set_mute(bool mute) { mute_ = mute; }
  virtual void set_frozen(bool frozen) { frozen_ = frozen; }
  virtual void set_saturated(bool saturated) { saturated_ = saturated; }
  /// Its clock jumps.
  virtual void step_clock(double /*by_s*/) {}
  /// It measures half as often; an instrument that is only asked has no rate.
  virtual void halve_rate() {}
  /// Its oscillator runs 1 % slow.
  virtual void set_slow(bool /*slow*/) {}
  /// Without current; with current again it is as it came from the maker.
  void set_power(bool on, double now_s) {
    if (on == powered_) return;
    powered_ = on;
    if (on) {
      switched_on(now_s);
    } else {
      switched_off(now_s);
    }
  }

 protected:
  void put(std::string bytes, double at_s) {
    if (hears() && !mute_) said_.push_back({at_s, std::move(bytes)});
  }
  virtual void switched_off(double /*now_s*/) {}
  virtual void switched_on(double /*now_s*/) {}
  [[nodiscard]] bool hears() const { return powered_ && !silent_; }
  bool silent_{false};
  bool frozen_{false};
  bool saturated_{false};

 private:
  bool powered_{true}, mute_{false};
  std::vector<Utterance> said_;
};

}  // namespace mgtd::rig
