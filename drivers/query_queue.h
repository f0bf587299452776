// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <deque>
#include <optional>
#include <string>
#include <utility>

#include "drivers/deadline.h"

/// One question at a time, for devices whose replies do not say what they answer.
///
/// A question without an answer is asked again (kAttempts times). The answer to the first asking may still
/// come late, so after a time-out, and after any question that had to be repeated, the line must have been
/// quiet for kQuiet_s before the next byte is sent; what comes in meanwhile is dropped by the owner
/// (`expecting` is null then). Messages that get no reply are sent in their turn.
namespace mgtd::drivers {

template <class Ask>
struct Query {
  Ask ask{};
  std::string send;
  std::size_t axis{0};
  std::string concerning;  ///< for messages: the command an error question is about
  bool answered{true};     ///< gets a reply
};

template <class Ask>
class QueryQueue {
 public:
  static constexpr int kAttempts = 3;
  static constexpr double kReply_s = 2.0;
  static constexpr double kQuiet_s = 0.3;

  void push(Query<Ask> query) { queue_.push_back(std::move(query)); }
  /// Forgets everything, sends `bytes` at once and lets the line become quiet.
  void interrupt(std::string_view bytes, Instant now) {
    queue_.clear();
    current_.reset();
    to_send_ += bytes;
    quiet_.set(now, kQuiet_s, 2);
  }
  void clear() {
    queue_.clear();
    current_.reset();
    to_send_.clear();
    quiet_.clear();
  }
  [[nodiscard]] bool idle() const { return !current_ && queue_.empty() && !quiet_.armed(); }

  /// The question whose answer is awaited; null when any line is unexpected.
  [[nodiscard]] const Query<Ask>* expecting() const {
    return current_ && !quiet_.armed() ? &*current_ : nullptr;
  }
  /// The awaited answer has come.
  void answered(Instant now) {
    if (attempts_ > 1) quiet_.set(now, kQuiet_s, 2);
    current_.reset();
  }
  /// An unexpected line: the quiet starts anew.
  void disturbed(Instant now) {
    if (quiet_.armed()) quiet_.set(now, kQuiet_s, 2);
  }

  /// Returns the question that was given up, if one was just now.
  [[nodiscard]] std::optional<Query<Ask>> on_tick(Instant now) {
    if (quiet_.armed()) {
      if (quiet_.passed(now)) {
        quiet_.clear();
        if (current_) say(now);
      }
      return std::nullopt;
    }
    if (!current_ || !deadline_.passed(now)) return std::nullopt;
    if (attempts_ >= kAttempts) return std::exchange(current_, std::nullopt);
    quiet_.set(now, kQuiet_s, 2);
    return std::nullopt;
  }
  /// What may be sent now.
  [[nodiscard]] std::string take_send(Instant now) {
    while (!current_ && !quiet_.armed() && !queue_.empty()) {
      current_ = std::move(queue_.front());
      queue_.pop_front();
      attempts_ = 0;
      say(now);
      if (!current_->answered) current_.reset();
    }
    return std::exchange(to_send_, {});
  }

 private:
  void say(Instant now) {
    ++attempts_;
    to_send_ += current_->send;
    deadline_.set(now, kReply_s);
  }

  std::deque<Query<Ask>> queue_;
  std::optional<Query<Ask>> current_;
  std::string to_send_;
  Deadline deadline_, quiet_;
  int attempts_{0};
};

}  // namespace mgtd::drivers
