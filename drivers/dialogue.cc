// SPDX-License-Identifier: Apache-2.0
#include "drivers/dialogue.h"

namespace mgtd::drivers {
namespace {

constexpr double kResend_s = 1.0;

bool matches(std::string_view line, std::string_view expected) {
  if (!expected.ends_with('*')) return line == expected;
  expected.remove_suffix(1);
  return line.starts_with(expected) && line.size() > expected.size();
}

}  // namespace

void Dialogue::start(Instant now) {
  outcome_ = Outcome::running;
  identity_.clear();
  answered_.clear();
  replies_.clear();
  enter(0, now);
}

void Dialogue::enter(std::size_t at, Instant now) {
  proving_ = false;
  heard_.clear();
  if (at >= steps_.size()) {
    outcome_ = Outcome::done;
    return;
  }
  at_ = at;
  attempts_ = 0;
  limit_.set(now, kDrainLimit_s);
  say(now);
}

void Dialogue::say(Instant now) {
  ++attempts_;
  to_send_ += proving_ ? replies_.front().send : step().send;
  resend_.set(now, kResend_s, pace_.quiet_ticks);
  switch (step().kind) {
    case Step::Kind::tell:
      deadline_.set(now, step().seconds, 1);
      break;
    case Step::Kind::drain:
      deadline_.set(now, step().seconds, pace_.quiet_ticks);
      break;
    case Step::Kind::ask:
      deadline_.set(now, step().seconds, pace_.answer_ticks);
      break;
  }
}

void Dialogue::on_line(std::string_view line, Instant now) {
  if (outcome_ != Outcome::running || step().kind != Step::Kind::ask) return;
  if (proving_) {
    if (line == replies_.front().line) enter(at_ + 1, now);
    return;
  }
  const bool refused = step().tolerant && !step().refusal.empty() && line == step().refusal;
  if (refused || (matches(line, step().reply) && !heard_before(line))) return take_reply(line, now);
  heard_ = line;
}

bool Dialogue::heard_before(std::string_view line) const {
  return std::any_of(replies_.begin(), replies_.end(),
                     [&](const Reply& reply) { return reply.line == line && reply.send != step().send; });
}

void Dialogue::take_reply(std::string_view line, Instant now) {
  answered_.push_back(step().send);
  proving_ = attempts_ > 1 && !replies_.empty();
  if (step().reply.ends_with('*') && line != step().refusal) {
    identity_ = line;
    replies_.push_back({step().send, identity_});
  }
  if (!proving_) return enter(at_ + 1, now);
  attempts_ = 0;
  say(now);
}

void Dialogue::on_tick(Instant now, std::uint64_t bytes_in) {
  if (outcome_ != Outcome::running) return;
  switch (step().kind) {
    case Step::Kind::tell:
      if (deadline_.passed(now)) enter(at_ + 1, now);
      break;
    case Step::Kind::ask:
      tick_ask(now);
      break;
    case Step::Kind::drain:
      tick_drain(now, bytes_in);
      break;
  }
}

void Dialogue::tick_ask(Instant now) {
  if (!deadline_.passed(now)) return;
  if (attempts_ < pace_.attempts) {
    say(now);
  } else if (step().tolerant) {
    enter(at_ + 1, now);
  } else {
    outcome_ = heard_.empty() ? Outcome::no_answer : Outcome::wrong_answer;
  }
}

void Dialogue::tick_drain(Instant now, std::uint64_t bytes_in) {
  const bool over = limit_.passed(now);
  const bool resend = resend_.passed(now);
  if (std::exchange(bytes_seen_, bytes_in) != bytes_in) {
    deadline_.set(now, step().seconds, pace_.quiet_ticks);
    if (over) {
      outcome_ = Outcome::never_silent;
    } else if (resend) {
      to_send_ += step().send;
      resend_.set(now, kResend_s, pace_.quiet_ticks);
    }
  } else if (deadline_.passed(now)) {
    enter(at_ + 1, now);
  }
}

}  // namespace mgtd::drivers
