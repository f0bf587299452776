// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/dcon_protocol.h"
#include "drivers/deadline.h"
#include "drivers/input_channel.h"
#include "drivers/line_device.h"
#include "drivers/settings.h"

/// A DconDriver asks an analogue input module for its channels at intervals: currents, voltages and
/// temperatures that act on the rig.
///
///   port, baud = 9600
///   address = "01"               two hexadecimal digits
///   checksum = false             as the module is set
///   channels = ["motor_A", "", "s3_T_degC"]   column of each input in its order; "" is not used
///   units = ["A", "", "degC"]    of the columns; when not given, as the ends of their names say
///   scale = [0.1, 1, 1]          column = scale * reading + offset; 1 and 0 when not given
///   offset = [0, 0, 0]
///   every_s = 1
///
/// What goes out is in input_channel.h; what a module calls out of range is not measured. Three questions in
/// a row without an answer make the link silent; it is asked on.
///
/// A reply does not say which question it answers. One question is asked at a time, and after one that was
/// not answered, or a line that nobody asked for, no value is believed until the module has said its name. A
/// module without a name must have been quiet instead, for as long as an answer may take.
namespace mgtd::drivers::dcon {

struct DconSettings {
  int baud{kDefaultBaud};
  std::string address{"01"};
  bool checksum{false};
  std::size_t inputs{0};               ///< of the module; no fewer than are used
  std::vector<InputChannel> channels;  ///< those that are used
  double every_s{1};
};

/// Mistakes are left in `settings`.
[[nodiscard]] DconSettings read_dcon_settings(Settings& settings);

class DconDriver final : public LineDevice {
 public:
  explicit DconDriver(DconSettings settings);
  [[nodiscard]] static std::unique_ptr<Device> make(int slot, Settings& settings);

  void on_open(Stamp now) override;
  void on_tick(Stamp now) override;
  [[nodiscard]] std::span<const InputChannel> inputs() const override { return settings_.channels; }

 protected:
  FrameResult on_line(std::string_view line, Stamp arrival) override;

 private:
  enum class Asked { nothing, name, values };

  void ask(Asked what, double patience_s, Instant now);
  void unanswered(Stamp now);
  void answered(Instant now);
  FrameResult on_name(const Name& name, Stamp arrival);
  FrameResult on_values(const Values& values, Stamp arrival);
  FrameResult on_refusal(Stamp arrival);
  FrameResult unasked();

  DconSettings settings_;
  Deadline next_, answer_;
  Asked asked_{Asked::nothing};
  bool proved_{false};     ///< what comes next answers what is asked
  bool has_name_{true};    ///< until it was asked for it in vain
  int missed_{0};          ///< questions in a row
  std::string strange_{};  ///< the last line that is none of such a module, since an answer
};

}  // namespace mgtd::drivers::dcon
