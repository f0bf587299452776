// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

#include "tests/rig/covariate.h"
#include "tests/rig/instrument.h"
#include "tests/rig/world.h"

/// This simulates an ObsDAQ digitiser with a fluxgate on its three inputs, alone or behind a PalmAcq
/// time-stamper.
///
/// Commands end in CR; address 01. `$01M` `$01F` `$01SN` `$012` `$01QF` `$01IR0`, channel n: `$01nWS0201ccdd`
/// `$01nRS` `$01nWOaaaaaa` `$01nRO` `$01nWFaaaaaa` `$01nRF` `$01nWCFk` `$01nRR`; `#01PPeeeeffff` `#01CS`
/// `#01ST`, quick stop by many `|`. Another address is met with silence, another command with `?01`. While
/// acquiring, only the two stops are heard. PalmAcq in front: `SM:TRP` (answered `AM:TRP,001B`) opens the way
/// through, bytes 00 1B close it; `SF:R` forwards with the time in front of each line, `SF:-` stops
/// forwarding.
namespace mgtd::rig {

class ObsdaqInstrument final : public Instrument {
 public:
  /// `slot` from 0 on. The device has its own oscillator and its own moment of switching on. The PalmAcq's
  /// clock shows `utc_s` at time 0.
  ObsdaqInstrument(World& world, int slot, double utc_s);

  void receive(std::string_view bytes, double now_s) override;
  void advance(double now_s) override;
  [[nodiscard]] double next_s() const override { return acquiring_ ? next_sample_s_ : 1e300; }
  [[nodiscard]] int baud() const override { return palmacq_ ? 57600 : 19200; }
  void step_clock(double by_s) override { utc_s_ += by_s; }
  void halve_rate() override { ticks_ *= 2; }
  void set_slow(bool slow) override { slow_ = slow; }
  /// Acquiring and forwarding before anybody asked (autostart in its EEPROM). The first the host sees is the
  /// end of a line.
  void autostart(double now_s);

 protected:
  void switched_off(double now_s) override;
  void switched_on(double now_s) override;

 private:
  struct Channel {
    std::string setup{"0233"};  ///< ccdd
    std::string offset{"000000"}, full_scale{"300000"};
    double calibrated_s{0};  ///< self-calibration ends
  };

  void byte(char c, double now_s);
  void palmacq_line(std::string_view line, double now_s);
  void obsdaq_line(std::string_view line, double now_s);
  [[nodiscard]] std::string dollar(std::string_view command, double now_s);
  [[nodiscard]] std::string channel_command(Channel& channel, std::string_view command, double now_s);
  [[nodiscard]] std::string hash(std::string_view command, double now_s);
  void start_acquisition(double now_s);
  [[nodiscard]] std::string sample_line(double t_s);
  [[nodiscard]] std::string supplement(double t_s) const;
  [[nodiscard]] std::string time_prefix(double t_s) const;
  [[nodiscard]] double period_s() const;
  [[nodiscard]] unsigned ticks_of(double rate_hz) const;

  World& world_;
  int slot_;
  double utc_s_;
  bool palmacq_;
  std::vector<Covariate> inputs_;  ///< auxiliary, beside the thermometer
  double oscillator_;              ///< length of its second
  bool slow_{false};
  bool transparent_{false}, forwarding_{false}, escape_{false};
  std::string line_;
  int bars_{0};
  bool acquiring_{false};
  unsigned ticks_{0};
  std::array<Channel, 3> channels_;
  double next_sample_s_{0}, next_supplement_s_{0};
  Eigen::Vector3d last_y_nT_{0, 0, 0};
};

}  // namespace mgtd::rig
