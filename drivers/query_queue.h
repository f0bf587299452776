// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "drivers/deadline.h"

/// A QueryQueue asks one question at a time, for devices whose replies do not say what they answer.
///
/// The line is in step while every question that was asked has been answered. It is out of step when a
/// question was broken off (interrupt), when a reply did not come in time, when a line came that answers
/// nothing, and when the port was opened. From then on no line is believed until the line has been proved:
///
///   draining   what is owed may still come, for as long as a reply may take
///   proving    a harmless question is asked whose reply looks like none that is owed. Replies come in the
///              order of their questions: when this one is there, all before it are past.
///   listening  nothing may follow it for a moment
///
/// Then the broken-off question is asked again. Which replies are owed is counted on the safe side: a line
/// pays the oldest question that it could answer, and those before it.
///
/// A question without a reply, or one that only strange lines follow, is given up. Does not know what a reply
/// means; its owner says of which form a line is.
namespace mgtd::drivers {

template <class Ask>
struct Query {
  Ask ask{};
  std::string send;
  std::string form;  ///< of its reply
  std::size_t axis{0};
  std::string concerning{};  ///< the command that an error question is about
};

/// A question that changes nothing, and the form of its reply.
struct Proof {
  std::string send;
  std::string form;
};

enum class Heard {
  answer,       ///< of the question under way
  passed_over,  ///< owed from before, or a proof
  strange,      ///< nobody asked for it
};

template <class Ask>
class QueryQueue {
 public:
  static constexpr int kAttempts = 3;
  static constexpr int kUpsets = 3;  ///< by strange lines, since the last answer
  static constexpr double kReply_s = 2.5;
  static constexpr double kQuiet_s = 0.1;
  static constexpr double kOpened_s = 0.3;  ///< before the first question on a port just opened
  static constexpr std::size_t kMostOwed = 64;

  /// At least two proofs of different forms; the first is preferred.
  explicit QueryQueue(std::vector<Proof> proofs) : proofs_(std::move(proofs)) {}

  void push(Query<Ask> query) { queue_.push_back(std::move(query)); }
  /// Forgets what was to be asked and sends `bytes` at once.
  void interrupt(std::string_view bytes, Instant now) {
    clear();
    to_send_ += bytes;
    drain(now);
  }
  /// The same on a port just opened: nobody knows what was asked before.
  void open(std::string_view bytes, Instant now) {
    for (auto proof = proofs_.rbegin(); proof != proofs_.rend(); ++proof) owe(proof->form);
    unanswered_ = upsets_ = 0;
    interrupt(bytes, now);
    deadline_.set(now, kOpened_s, kQuietTicks);
  }
  /// What is owed stays owed.
  void clear() {
    queue_.clear();
    current_.reset();
    to_send_.clear();
  }
  [[nodiscard]] bool idle() const { return !current_ && queue_.empty() && step_ == Step::in_step; }

  /// A line of this form came in.
  [[nodiscard]] Heard hear(std::string_view form, Instant now) {
    const auto paid = std::find(owed_.begin(), owed_.end(), form);
    const bool strange = paid == owed_.end();
    if (!strange) owed_.erase(owed_.begin(), std::next(paid));
    if (step_ == Step::in_step && !strange) return Heard::answer;
    if (step_ == Step::in_step || step_ == Step::listening) {
      ++upsets_;
      drain(now);
    } else if (step_ == Step::draining) {
      quiet_.set(now, kQuiet_s, kQuietTicks);
    } else if (owed_.empty()) {
      step_ = Step::listening;
      quiet_.set(now, kQuiet_s, kQuietTicks);
    } else if (form == proof_form_) {
      prove(now);  // an older question's, perhaps
    }
    return strange ? Heard::strange : Heard::passed_over;
  }
  /// The question whose answer has come.
  [[nodiscard]] const Query<Ask>& current() const { return *current_; }
  void answered() {
    current_.reset();
    unanswered_ = upsets_ = 0;
  }
  /// The line that was taken for the answer is none.
  void refused(Instant now) {
    owe(current_->form);
    ++upsets_;
    drain(now);
  }

  /// Returns what was asked last when it is given up.
  [[nodiscard]] std::optional<std::string> on_tick(Instant now) {
    if (upsets_ > kUpsets) return give_up();
    switch (step_) {
      case Step::in_step:
        return current_ && deadline_.passed(now) ? unanswered(now) : std::nullopt;
      case Step::proving:
        return deadline_.passed(now) ? unanswered(now) : std::nullopt;
      case Step::draining: {
        const bool quiet = quiet_.passed(now), late = deadline_.passed(now);
        if (late || (quiet && owed_.empty())) prove(now);
        return std::nullopt;
      }
      case Step::listening:
        if (!quiet_.passed(now)) return std::nullopt;
        step_ = Step::in_step;
        if (current_) say(now);
        return std::nullopt;
    }
    return std::nullopt;
  }
  /// What may be sent now.
  [[nodiscard]] std::string take_send(Instant now) {
    if (step_ == Step::in_step && !current_ && !queue_.empty()) {
      current_ = std::move(queue_.front());
      queue_.pop_front();
      say(now);
    }
    return std::exchange(to_send_, {});
  }

 private:
  enum class Step { in_step, draining, proving, listening };
  static constexpr int kQuietTicks = 2;

  void owe(const std::string& form) {
    owed_.push_back(form);
    if (owed_.size() > kMostOwed) owed_.pop_front();
  }
  void say(Instant now) { send(current_->send, current_->form, now); }
  void send(const std::string& bytes, const std::string& form, Instant now) {
    to_send_ += asked_ = bytes;
    owe(form);
    deadline_.set(now, kReply_s);
  }
  void drain(Instant now) {
    step_ = Step::draining;
    deadline_.set(now, kReply_s);
    quiet_.set(now, kQuiet_s, kQuietTicks);
  }
  /// By the question whose reply is soonest told from those that are owed.
  void prove(Instant now) {
    const auto first_owed = [&](const Proof& p) { return std::find(owed_.begin(), owed_.end(), p.form); };
    const auto best = std::max_element(proofs_.begin(), proofs_.end(), [&](const Proof& a, const Proof& b) {
      return first_owed(a) < first_owed(b);
    });
    step_ = Step::proving;
    proof_form_ = best->form;
    send(best->send, best->form, now);
  }
  [[nodiscard]] std::optional<std::string> unanswered(Instant now) {
    if (++unanswered_ >= kAttempts) return give_up();
    prove(now);
    return std::nullopt;
  }
  [[nodiscard]] std::string give_up() {
    unanswered_ = upsets_ = 0;
    return asked_;
  }

  std::vector<Proof> proofs_;
  std::deque<Query<Ask>> queue_;
  std::optional<Query<Ask>> current_;
  std::deque<std::string> owed_;  ///< forms of the replies, in the order of their questions
  std::string to_send_, asked_, proof_form_;
  Step step_{Step::in_step};
  Deadline deadline_, quiet_;
  int unanswered_{0}, upsets_{0};
};

}  // namespace mgtd::drivers
