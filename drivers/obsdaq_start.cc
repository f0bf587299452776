// SPDX-License-Identifier: Apache-2.0
#include "drivers/obsdaq_start.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "drivers/obsdaq_protocol.h"

namespace mgtd::drivers::obsdaq {
namespace {

using Kind = Step::Kind;

constexpr double kTriggerOff_s = 1.0;  ///< before channels may be configured

struct Waits {
  double short_s, long_s;  ///< after a command that needs no, or some, work
  double quiet_s;          ///< ends a drain
  double reply_s, optional_reply_s;
  Pace pace;
};
constexpr Waits kBrisk{0.02, 0.02, 0.1, 0.4, 0.3, {2, 20, 5}};
constexpr Waits kPatient{0.2, 0.3, 0.3, 2.0, 0.3, {}};

class Conversation {
 public:
  Conversation(const ObsdaqSettings& settings, const Waits& waits) : s_(settings), w_(waits) {}

  std::vector<Step> steps() {
    if (s_.palmacq) enter_transparent();
    stop_and_identify();
    ask(trigger(s_.address, 0, 0));
    tell("", kTriggerOff_s);
    for (int channel = 0; channel < 3; ++channel)
      ask(configure(s_.address, channel, s_.range.code, s_.timing.rate_code));
    ask(trigger(s_.address, s_.timing.period, s_.timing.low));
    ask(start(s_.address));
    if (s_.palmacq) enter_forwarding();
    return std::move(steps_);
  }

 private:
  void tell(std::string what, double pause_s) {
    steps_.push_back({Kind::tell, std::move(what), "", pause_s});
  }
  void drain(std::string what) { steps_.push_back({Kind::drain, std::move(what), "", w_.quiet_s}); }
  void ask(const Exchange& exchange) {
    steps_.push_back({Kind::ask, exchange.command, exchange.reply, w_.reply_s});
  }

  void enter_command_mode() {
    tell(std::string("\x00\x1B", 2), w_.short_s);
    tell("SM:CMD\r", w_.long_s);
  }
  /// Leaves whatever mode a PalmAcq was left in and connects through to the ObsDAQ.
  void enter_transparent() {
    enter_command_mode();
    drain("SF:-\r");
    tell("SP:R:19200,8,n,1,1\r", w_.long_s);
    tell("ST:R\r", w_.long_s);
    const Exchange through = connect_through();
    steps_.push_back({Kind::ask, through.command, through.reply, w_.reply_s, true});
  }
  void stop_and_identify() {
    drain(quick_stop());
    tell(stop(s_.address), w_.short_s);
    steps_.push_back({Kind::ask, identify(s_.address), fmt::format("!{}*", s_.address), w_.reply_s});
    Step serial{Kind::ask, serial_number(s_.address), fmt::format("!{}*", s_.address),
                s_.serial.empty() ? w_.optional_reply_s : w_.reply_s};
    serial.tolerant = s_.serial.empty();  // an old firmware that does not know the question
    serial.refusal = fmt::format("?{}", s_.address);
    steps_.push_back(serial);
    steps_.push_back(std::move(serial));
  }
  void enter_forwarding() {
    enter_command_mode();
    tell("SF:R\r", 0);
  }

  const ObsdaqSettings& s_;
  const Waits& w_;
  std::vector<Step> steps_;
};

}  // namespace

Dialogue start_up(const ObsdaqSettings& settings, Patience patience) {
  const Waits& waits = patience == Patience::brisk ? kBrisk : kPatient;
  return Dialogue(Conversation(settings, waits).steps(), waits.pace);
}

}  // namespace mgtd::drivers::obsdaq
