// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "tests/rig/instrument.h"
#include "tests/rig/world.h"

/// This simulates a GSM-90 Overhauser magnetometer, firmware 7: it prints a line a second, "HHMMSS.f  nT qq".
/// Strings without terminator set it up, each answered by menu text: S stops it, 5 or 6 the mains filter,
/// Tnnn.n the tuning, C and 13 digits the clock, D slower, U faster, R runs it.
namespace mgtd::rig {

class GsmInstrument final : public Instrument {
 public:
  GsmInstrument(World& world, double utc_s);

  void receive(std::string_view bytes, double now_s) override;
  void advance(double now_s) override;
  [[nodiscard]] double next_s() const override { return running_ ? next_s_ : 1e300; }
  [[nodiscard]] int baud() const override { return 115200; }
  void step_clock(double by_s) override { utc_s_ += by_s; }
  void halve_rate() override { period_s_ *= 2; }

 protected:
  void switched_off(double now_s) override;
  void switched_on(double now_s) override;

 private:
  void menu(char c, double now_s);
  void line(double at_s);

  World& world_;
  double utc_s_;
  double period_s_;
  bool running_{true};
  std::size_t digits_{0};  ///< of tuning or clock still to come
  double next_s_{0.4};
  double last_nT_{0};
  std::uint64_t readings_{0};
};

}  // namespace mgtd::rig
