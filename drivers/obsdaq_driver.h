// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "drivers/deadline.h"
#include "drivers/dialogue.h"
#include "drivers/line_device.h"
#include "drivers/obsdaq_settings.h"
#include "drivers/obsdaq_start.h"
#include "drivers/rate_watch.h"

/// An ObsdaqDriver starts and verifies one fluxgate behind an ObsDAQ and keeps it streaming.
///
///   probing  as obsdaq_start.h: briskly, and patiently when that leads to nothing
///   live     FieldReading per line; once a second TemperatureReading and what its inputs are used for
///   silent   no answer, or no valid line for 1 s (10 periods when slower): started over; the port is opened
///            again when nothing at all came for 10 s
///   failed   the port answers with something else, or is another one than stated: DeviceFault, tried again
///            every 10 s
///
/// y_nT = volts * scale_nT_per_V + offset_nT, per axis. seq counts from the start of the acquisition; a
/// rejected line counts as many samples as it shows starts of ('*'), at least one unless it is a reply. Lines
/// that left no trace are not known here.
namespace mgtd::drivers::obsdaq {

class ObsdaqDriver final : public LineDevice {
 public:
  ObsdaqDriver(int slot, ObsdaqSettings settings);
  [[nodiscard]] static std::unique_ptr<Device> make(int slot, Settings& settings);

  void on_open(Stamp now) override;
  void on_tick(Stamp now) override;
  void on_close(Stamp now) override;
  void on_shutdown(Stamp now) override;
  [[nodiscard]] std::span<const InputChannel> inputs() const override { return settings_.inputs; }
  [[nodiscard]] std::size_t line_bytes() const override {
    return kLineBytes + (settings_.palmacq ? kPrefixBytes : 0);
  }

 protected:
  FrameResult on_line(std::string_view line, Stamp arrival) override;
  void on_damaged_line(std::string_view text) override;

 private:
  enum class Phase { closed, starting, streaming, waiting };

  void start(Patience patience, Stamp now);
  void pump(Stamp now);
  [[nodiscard]] bool identified(Stamp now);
  [[nodiscard]] bool tells_serial(std::string_view said, Stamp now);
  void identify(Stamp now, std::string as);
  void go_live(Stamp now);
  void show_live();
  [[nodiscard]] std::string hint_at_palmacq() const;
  void give_up(Stamp now);
  void refuse(Stamp now, std::string what, std::string remedy);
  void watch_silence(Stamp now);
  void watch_rate(Stamp now);
  FrameResult on_stream_line(std::string_view line, Stamp arrival);
  void emit_sample(const Sample& sample, Stamp arrival);
  [[nodiscard]] double silence_s() const;

  int slot_;
  ObsdaqSettings settings_;
  Phase phase_{Phase::closed};
  Patience patience_{Patience::brisk};
  Dialogue dialogue_;
  Deadline silence_, retry_;
  std::string identity_heard_, model_, serial_;  ///< in the conversation under way
  RateWatch rate_;
  std::uint64_t seq_{0};
  std::uint64_t bytes_at_good_line_{0};
  bool any_good_line_{false};
  bool without_time_{false};  ///< a line came as one does without a PalmAcq, since the start
  bool impossible_date_noted_{false};
  std::string last_fault_;
};

}  // namespace mgtd::drivers::obsdaq
