// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>

#include "tests/rig/instrument.h"
#include "tests/rig/world.h"

/// An ObsDAQ digitiser with a fluxgate on its three inputs, alone or behind a PalmAcq time-stamper.
///
/// Commands end in CR; address 01. `$01M`, `$01nWS0201ccdd`, `$01nRS`, `#01PPeeeeffff`, `#01CS`, `#01ST`,
/// quick stop by many `|`. Another address is met with silence, another command with `?01`. While acquiring,
/// only the quick stop is heard. PalmAcq in front: `SM:TRP` (answered `AM:TRP,001B`) opens the way through,
/// bytes 00 1B close it; `SF:R` forwards with the time in front of each line, `SF:-` stops forwarding.
namespace mgtd::rig {

class ObsdaqInstrument final : public Instrument {
 public:
  /// `slot` 0 .. 3. The device has its own oscillator and its own moment of switching on. The PalmAcq's clock
  /// starts at `utc_s`.
  ObsdaqInstrument(World& world, int slot, double utc_s);

  void receive(std::string_view bytes, double now_s) override;
  void advance(double now_s) override;
  [[nodiscard]] double next_s() const override { return acquiring_ ? next_sample_s_ : 1e300; }
  [[nodiscard]] int baud() const override { return palmacq_ ? 57600 : 19200; }
  /// Acquiring and forwarding before anybody asked (autostart in its EEPROM).
  void autostart(double now_s);

 private:
  void palmacq_line(std::string_view line);
  void obsdaq_line(std::string_view line, double now_s);
  void reply(std::string_view text);
  void start_acquisition(double now_s);
  [[nodiscard]] std::string sample_line(double t_s);
  [[nodiscard]] std::string supplement(double t_s) const;
  [[nodiscard]] std::string time_prefix(double t_s) const;
  [[nodiscard]] double period_s() const { return ticks_ * 64 / 9.8304e6 * oscillator_; }

  World& world_;
  int slot_;
  double utc_s_;
  bool palmacq_;
  double oscillator_;  ///< length of its second
  bool transparent_{false}, forwarding_{false}, escape_{false};
  std::string line_;
  int bars_{0};
  bool acquiring_{false};
  unsigned ticks_{0};
  std::array<std::string, 3> channel_{"0233", "0233", "0233"};
  double next_sample_s_{0}, next_supplement_s_{0};
  Eigen::Vector3d last_y_nT_{0, 0, 0};
};

}  // namespace mgtd::rig
