// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/deadline.h"
#include "drivers/gsm_protocol.h"
#include "drivers/line_device.h"
#include "drivers/settings.h"
#include "proto/error.h"

/// A GsmDriver listens to a GSM-90 or GSM-19, the scalar reference, after sending the set-up strings of the
/// configuration, if there are any.
///
///   port, baud = 115200
///   init = []                      set-up strings, sent one by one without ending, at least a second apart:
///                                  ["S", "5", "T048.5", "C", "{utc}", "R"], {utc} = time for the clock menu
///   serial = ""                    of the instrument; stated: one whose header tells another is refused
///   range_nT = [20000, 120000]     a reading outside is rejected
///   silence_s = 15                 without a reading the link is silent; failed where something else talks
///   on
///
/// Its serial number is in the header that it prints when it starts; one that prints none is believed.
///
/// A ScalarReading is good when its quality is 99, or when the line has no quality at all (quality -1): then
/// nothing speaks against it. A menu that offers "z-save" is answered by z.
namespace mgtd::drivers::gsm {

struct GsmSettings {
  int baud{kDefaultBaud};
  std::vector<std::string> init;
  std::string serial;  ///< empty: any
  double min_nT{20'000};
  double max_nT{120'000};
  double silence_s{15};
};

/// Mistakes are left in `settings`.
[[nodiscard]] GsmSettings read_gsm_settings(Settings& settings);

class GsmDriver final : public LineDevice {
 public:
  explicit GsmDriver(GsmSettings settings);
  [[nodiscard]] static std::unique_ptr<Device> make(int slot, Settings& settings);

  void on_open(Stamp now) override;
  void on_tick(Stamp now) override;

 protected:
  FrameResult on_line(std::string_view line, Stamp arrival) override;

 private:
  void send_init(Stamp now);
  void identify(std::string_view header, Stamp now);
  FrameResult on_reading(const GsmReading& reading, Stamp arrival);

  GsmSettings settings_;
  std::size_t next_init_{0};
  Deadline next_, silence_;
  std::string last_text_;  ///< since the last reading
  Instant last_text_at_{};
  std::optional<Error> another_;  ///< it is not the instrument that was stated
};

}  // namespace mgtd::drivers::gsm
