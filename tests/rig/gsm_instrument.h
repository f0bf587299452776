// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "tests/rig/instrument.h"
#include "tests/rig/world.h"

/// A GSM-90 Overhauser magnetometer, firmware 7: a line a second, "HHMMSS.f  nT qq". `S` brings the menu and
/// stops it, `R` runs it.
namespace mgtd::rig {

class GsmInstrument final : public Instrument {
 public:
  GsmInstrument(World& world, double utc_s) : world_(world), utc_s_(utc_s) {}

  void receive(std::string_view bytes, double now_s) override;
  void advance(double now_s) override;
  [[nodiscard]] double next_s() const override { return running_ ? next_s_ : 1e300; }
  [[nodiscard]] int baud() const override { return 115200; }

 private:
  World& world_;
  double utc_s_;
  bool running_{true};
  double next_s_{0.4};
  double last_nT_{0};
};

}  // namespace mgtd::rig
