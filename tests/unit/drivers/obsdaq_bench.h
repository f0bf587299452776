// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gmock/gmock.h>

#include <string>
#include <utility>
#include <vector>

#include "drivers/obsdaq_driver.h"
#include "tests/support/device_bench.h"

/// An ObsDAQ that answers as in the captured dialogues, and its driver before it.
namespace mgtd::drivers::obsdaq {

using mgtd::testing::DeviceBench;
using ::testing::HasSubstr;

/// A digitiser on the bench, optionally behind a PalmAcq; answers as in the captured dialogues.
struct Instrument {
  std::string identity{"!01<obsDAQ V5.5.7>"};
  std::string serial{"1001"};  ///< empty: a firmware that does not know the question
  int damaged_serials{0};      ///< so many answers to the question for it lose a digit
  std::string spoil;           ///< commands that start so are answered by "?01"
  std::string mute;            ///< commands that start so are not answered
  bool palmacq{false};
  bool streaming{false};
  bool transparent{false}, forwarding{false};
  std::string command;
  std::vector<std::string> commands;

  std::string operator()(std::string_view sent) {
    std::string out;
    for (const char c : sent) {
      if (c == '|') {
        streaming = false;
      } else if (c == '\x1B') {
        transparent = false;
        command.clear();
      } else if (c == '\r') {
        commands.push_back(command);
        out += answer(std::exchange(command, {}));
      } else if (c != '\0') {
        command += c;
      }
    }
    return out;
  }

  std::string answer(const std::string& c) {
    if (palmacq && !transparent) {
      if (c == "SM:TRP") transparent = true;
      if (c == "SF:R") forwarding = true;
      if (c == "SF:-") forwarding = false;
      return c == "SM:TRP" ? "AM:TRP,001B\r" : "";
    }
    if (!mute.empty() && c.starts_with(mute)) return "";
    if (!spoil.empty() && c.starts_with(spoil)) return "?01\r";
    if (c == "#01ST") {
      streaming = false;
      return "";
    }
    if (c == "$01M") return identity + "\r";
    if (c == "$01SN" && damaged_serials-- > 0) return "!01SN101\r";
    if (c == "$01SN" && !serial.empty()) return "!01SN" + serial + "\r";
    if (c.starts_with("#01PP")) return "!01" + c.substr(5) + "\r";
    if (c.size() == 14 && c.substr(4, 2) == "WS") return "!01" + c.substr(6) + "\r";
    if (c == "#01CS") {
      streaming = true;
      return "!01\r";
    }
    return "?01\r";
  }
};

inline ObsdaqSettings settings(bool palmacq = false) {
  Settings s("[[sensor]] s3", 1);
  s.set("profile", std::string("mag-13-100"), 2);
  s.set("palmacq", palmacq, 3);
  s.set("temperature", std::string("p"), 4);
  s.set("degC_per_V", 100.0, 5);
  s.set("degC_at_0V", -5.0, 6);
  s.set("inputs.q.name", std::string("motor_A"), 7);
  s.set("inputs.q.unit", std::string("A"), 8);
  s.set("inputs.q.scale", 2.0, 9);
  s.set("inputs.q.offset", 0.5, 10);
  s.set("inputs.r.name", std::string("s1_T_degC"), 11);
  s.set("inputs.r.unit", std::string("degC"), 12);
  s.set("inputs.r.scale", 10.0, 13);
  ObsdaqSettings out = read_obsdaq_settings(s, 2);
  EXPECT_TRUE(s.errors().empty());
  return out;
}

class ObsdaqDriverTest : public ::testing::Test {
 protected:
  void go_live() {
    bench.open();
    ASSERT_TRUE(bench.pass_until([&] { return driver.health().state == LinkState::live; }));
    bench.forget_events();
  }
  Instrument instrument;
  ObsdaqDriver driver{2, settings()};
  DeviceBench bench{driver, std::ref(instrument)};
};

}  // namespace mgtd::drivers::obsdaq
