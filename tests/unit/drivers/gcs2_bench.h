// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "drivers/gcs2_driver.h"
#include "proto/units.h"
#include "tests/support/device_bench.h"

namespace mgtd::drivers::gcs2 {

using mgtd::testing::DeviceBench;
using ::testing::HasSubstr;

/// A controller as documented: silent on set commands, error register, servo and reference needed to move.
struct Controller {
  struct Axis {
    double position{3}, target{3}, min{-170}, max{170};
    bool servo{false}, referenced{false};
  };
  std::map<std::string, Axis> axes{{"1", {}}};
  double velocity{10};
  int error{0};
  double referencing_until{-1};
  double now{0}, last{0};
  bool stalls{false};  ///< does not move
  bool reference_fails{false};
  std::string mute;   ///< messages that start so get no answer ...
  int mute_times{0};  ///< ... this often
  std::string command;
  std::vector<std::string> commands;  ///< that set something

  std::string operator()(std::string_view sent) {
    std::string out;
    for (const char c : sent) {
      if (c == '\x18') {
        for (auto& [name, axis] : axes) axis.target = axis.position;
        error = 10;
        commands.emplace_back("stop");
        command.clear();
      } else if (c == '\x05') {
        out += fmt::format("{:X}\n", moving());
      } else if (c == '\x07') {
        out += now < referencing_until ? "\xB0\n" : "\xB1\n";
      } else if (c == '\n') {
        out += answer(std::exchange(command, {}));
      } else {
        command += c;
      }
    }
    return out;
  }
  void advance(double t) {
    for (auto& [name, axis] : axes) {
      const double step = velocity * (t - last);
      if (!stalls) axis.position += std::clamp(axis.target - axis.position, -step, step);
    }
    now = last = t;
  }
  [[nodiscard]] unsigned moving() const {
    unsigned mask = 0, bit = 1;
    for (const auto& [name, axis] : axes) {
      if (!stalls && axis.position != axis.target) mask |= bit;
      bit *= 2;
    }
    return mask;
  }
  std::string answer(const std::string& line) {
    if (mute_times > 0 && line.starts_with(mute)) {
      --mute_times;
      return "";
    }
    const std::string head = line.substr(0, line.find(' '));
    if (head == "ERR?") return fmt::format("{}\n", std::exchange(error, 0));
    if (head == "*IDN?") return "(c)2015 Physik Instrumente, C-867, 1, 1.2\n";
    if (head == "SAI?") {
      std::string out;
      for (const auto& [name, axis] : axes) out += (out.empty() ? "" : " \n") + name;
      return out + "\n";
    }
    const std::string name = line.substr(head.size() + 1, 1);
    const auto found = axes.find(name);
    if (found == axes.end()) {
      error = 15;
      return "";
    }
    return answer(line, head, name, found->second);
  }
  std::string answer(const std::string& line, const std::string& head, const std::string& name, Axis& axis) {
    const auto reply = [&](auto value) { return fmt::format("{}={}\n", name, value); };
    if (head == "POS?") return reply(axis.position);
    if (head == "ONT?") return reply(axis.servo && axis.position == axis.target ? 1 : 0);
    if (head == "TMN?") return reply(axis.min);
    if (head == "TMX?") return reply(axis.max);
    if (head == "FRF?") return reply(axis.referenced ? 1 : 0);
    commands.push_back(line);
    const std::string value = line.size() > 6 ? line.substr(6) : "";
    if (head == "SVO") axis.servo = value == "1";
    if (head == "VEL") velocity = std::stod(value);
    if (head == "FRF") {
      referencing_until = now + 2;
      axis.referenced = !reference_fails;
      axis.position = axis.target = 0;
    }
    if (head == "MOV") {
      const double target = std::stod(value);
      if (!axis.servo || !axis.referenced) {
        error = 5;
      } else if (target < axis.min || target > axis.max) {
        error = 7;
      } else {
        axis.target = target;
      }
    }
    return "";
  }
};

inline Gcs2Settings settings(std::map<std::string, Settings::Value> more = {}) {
  Settings s("[table]", 1);
  int line = 2;
  for (auto& [key, value] : more) s.set(key, value, line++);
  Gcs2Settings out = read_gcs2_settings(s);
  EXPECT_TRUE(s.errors().empty());
  return out;
}

class Gcs2DriverTest : public ::testing::Test {
 protected:
  explicit Gcs2DriverTest(std::map<std::string, Settings::Value> more = {})
      : driver(settings(std::move(more))) {}

  void open() {
    bench.open();
    ASSERT_TRUE(until([&] { return driver.health().state == LinkState::live; }));
  }
  void home() {
    open();
    driver.home();
    bench.exchange();
    ASSERT_TRUE(until([&] { return last().referenced && !last().moving; }));
    controller.commands.clear();
    bench.forget_events();
  }
  bool until(const std::function<bool()>& condition, double limit_s = 120) {
    return bench.pass_until(
        [&] {
          controller.advance(bench.t_s());
          return condition();
        },
        limit_s);
  }
  [[nodiscard]] TableReading last() const {
    const auto readings = bench.events<TableReading>();
    return readings.empty() ? TableReading{} : readings.back();
  }
  [[nodiscard]] std::vector<DeviceFault> faults() const { return bench.events<DeviceFault>(); }
  void move(double azimuth_deg) {
    driver.move_to({to_rad(azimuth_deg), 0, 0});
    bench.exchange();
  }

  Controller controller;
  Gcs2Driver driver;
  DeviceBench bench{driver, std::ref(controller)};
};

}  // namespace mgtd::drivers::gcs2
