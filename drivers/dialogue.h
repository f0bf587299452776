// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "drivers/deadline.h"

/// A Dialogue is a start-up conversation, given as a list of steps and carried out in virtual or real time
/// alike.
///
///   tell   send, then let `seconds` pass; what comes in is of no interest
///   drain  send, and again every second while bytes still come, until none came for `seconds`
///   ask    send, and wait up to `seconds` for the reply; asked `attempts` times
///
/// A reply that was waited for in vain may still come: a question that was asked twice may be answered twice.
/// So after such a one the device is asked who it is, until it says it again, before the next step. A line
/// that told an identity before is never the reply to another question.
///
/// The owner feeds lines and ticks, sends what take_send() gives, and reads the outcome.
namespace mgtd::drivers {

struct Step {
  enum class Kind { tell, drain, ask } kind{Kind::tell};
  std::string send;
  std::string reply;  ///< ask: the whole line expected; ends in '*': any line that starts so and is longer
  double seconds{0};
  bool tolerant{false};   ///< ask: go on when no reply came ...
  std::string refusal{};  ///< ... or when a line is this
};

/// How long it waits beside the seconds of its steps.
struct Pace {
  int attempts{3};                         ///< of an ask
  int answer_ticks{Deadline::kFairTicks};  ///< that an answer is waited for at least
  int quiet_ticks{15};                     ///< without a byte that end a drain: silence blames nobody
};

class Dialogue {
 public:
  static constexpr double kDrainLimit_s = 10.0;

  enum class Outcome { running, done, no_answer, wrong_answer, never_silent };

  explicit Dialogue(std::vector<Step> steps = {}, Pace pace = {}) : steps_(std::move(steps)), pace_(pace) {}

  void start(Instant now);
  void on_line(std::string_view line, Instant now);
  /// `bytes_in` counts all bytes ever received: how drain sees that the line is not yet silent.
  void on_tick(Instant now, std::uint64_t bytes_in);

  [[nodiscard]] Outcome outcome() const { return outcome_; }
  [[nodiscard]] std::string take_send() { return std::exchange(to_send_, {}); }
  /// Where it stands or ended.
  [[nodiscard]] const Step& step() const { return steps_.at(at_); }
  /// A step that sent this had its reply.
  [[nodiscard]] bool answered(std::string_view send) const {
    return std::find(answered_.begin(), answered_.end(), send) != answered_.end();
  }
  /// The last line that was not the expected one; empty when nothing came.
  [[nodiscard]] const std::string& heard() const { return heard_; }
  /// The last reply to an ask whose reply ends in '*'.
  [[nodiscard]] const std::string& identity() const { return identity_; }

 private:
  void enter(std::size_t at, Instant now);
  void say(Instant now);
  void take_reply(std::string_view line, Instant now);
  [[nodiscard]] bool heard_before(std::string_view line) const;
  void tick_ask(Instant now);
  void tick_drain(Instant now, std::uint64_t bytes_in);

  std::vector<Step> steps_;
  Pace pace_;
  std::size_t at_{0};
  Outcome outcome_{Outcome::running};
  std::string to_send_, heard_, identity_;
  Deadline deadline_, resend_, limit_;
  int attempts_{0};
  bool proving_{false};                ///< it has its reply, and is asked who it is
  std::vector<std::string> answered_;  ///< what was sent
  struct Reply {
    std::string send, line;
  };
  std::vector<Reply> replies_;  ///< replies to asks whose reply ends in '*'
  std::uint64_t bytes_seen_{0};
};

}  // namespace mgtd::drivers
