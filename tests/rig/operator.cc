// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/operator.h"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <thread>

#include "proto/standard_output.h"
#include "tests/rig/deed.h"
#include "tests/rig/fault_client.h"

namespace mgtd::rig {
namespace {

using nlohmann::json;
constexpr int kMisread = 2;  ///< entries of a blunder: the one, and the same again when it is doubted
constexpr std::array kAxes{"azimuth_deg", "pitch_deg", "roll_deg"};

class Operator {
 public:
  explicit Operator(const OperatorOptions& options) : options_(options), random_(options.seed) {}

  int work();
  int hold_magnets() const;

 private:
  [[nodiscard]] std::optional<json> say(const std::string& command, const json& args) const {
    const auto line = ask_socket(options_.control, json{{"cmd", command}, {"args", args}}.dump());
    if (!line) return std::nullopt;
    return json::parse(*line, nullptr, false);
  }
  void serve(const json& prompt);
  void do_deed(const std::string& text) const;
  void wait(double simulated_s) const;

  OperatorOptions options_;
  std::mt19937_64 random_;
  int prompts_{0}, asked_again_{0};
  std::array<double, 3> there_deg_{};
};

void Operator::serve(const json& prompt) {
  const bool again = prompt.at("again").is_string() && prompts_ > 0;  // only looked at again
  asked_again_ = again ? asked_again_ + 1 : 0;
  if (!again) ++prompts_;
  json entry;
  for (std::size_t a = 0; a < kAxes.size(); ++a) {
    const double sloppy = static_cast<double>(random_() >> 11U) * 0x1p-52 - 1;
    const double wanted = prompt.at("target").at(kAxes[a]);
    // What is read to a tenth is where it stands to half of that.
    if (!again) there_deg_[a] = std::round(10 * (wanted + options_.error_deg * sloppy)) / 10;
    entry[kAxes[a]] = there_deg_[a];
  }
  static_cast<void>(
      ask_rig(options_.dir, fmt::format("mount {} {} {}", there_deg_[0], there_deg_[1], there_deg_[2])));
  if (prompts_ == options_.blunder && asked_again_ < kMisread)
    entry["roll_deg"] = entry["roll_deg"].get<double>() + 30;
  fmt::print("{}\n{}{}\n", prompt.at("text").get<std::string>(),
             again ? "  " + prompt.at("again").get<std::string>() + "\n" : "", entry.dump());
  flush_standard_output();
  static_cast<void>(say("run.enter", entry));
}

void Operator::wait(double simulated_s) const {
  const auto now_s = [&]() -> std::optional<double> {
    const auto status = ask_rig(options_.dir, "status");
    if (!status) return std::nullopt;
    return json::parse(*status, nullptr, false).value("t_s", 0.0);
  };
  const auto begun_s = now_s();
  while (begun_s) {
    const auto at_s = now_s();
    if (!at_s || *at_s >= *begun_s + simulated_s) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

/// Where the hands cannot do it the run ends with what it has.
void Operator::do_deed(const std::string& text) const {
  const auto asked = deed_of(text);
  bool done = asked.has_value();
  fmt::print("{}\n", text);
  for (const std::string& line : asked ? asked->lines : std::vector<std::string>{}) {
    done = done && ask_rig(options_.dir, line);
    fmt::print("{}\n", line);
  }
  if (!done) fmt::print("cannot be done here\n");
  flush_standard_output();
  if (done) wait(asked->wait_s);
  static_cast<void>(say(done ? "run.resume" : "run.finish", json::object()));
}

int Operator::work() {
  for (bool told = false;; std::this_thread::sleep_for(std::chrono::milliseconds(20))) {
    const auto reply = say("run.status", json::object());
    if (!reply || !reply->value("ok", false)) return 3;
    const json& run = reply->at("result");
    const std::string state = run.at("state");
    const bool paused = state == "paused";
    if (run.at("prompt").is_object() && run.at("prompt").at("what") == "note") {
      do_deed(run.at("prompt").at("text"));
    } else if (run.at("prompt").is_object()) {
      serve(run.at("prompt"));
    } else if (state == "done") {
      return 0;
    } else if (state == "rejected" || state == "aborted" || state == "failed" || (paused && !told)) {
      fmt::print(stderr, "{}: {}\n", state, run.at("message").get<std::string>());
      if (!paused) return 1;
    }
    told = paused;
  }
}

int Operator::hold_magnets() const {
  for (bool begun = false;; std::this_thread::sleep_for(std::chrono::milliseconds(20))) {
    const auto reply = say("magnet-test.status", json::object());
    if (!reply) return 3;
    const json status = reply->value("result", json::object());
    const bool active = status.value("active", false);
    if (!active && begun) return status.value("state", "") == "done" ? 0 : 1;
    begun = begun || active;
    const bool here = active && status.value("state", "") == "waiting";
    static_cast<void>(
        ask_rig(options_.dir, fmt::format("magnet {}", here ? status.at("arm").get<int>() : 0)));
  }
}

}  // namespace

int operate(const OperatorOptions& options) {
  Operator hands(options);
  return options.magnet ? hands.hold_magnets() : hands.work();
}

}  // namespace mgtd::rig
