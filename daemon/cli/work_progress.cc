// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/work_progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <string_view>
#include <utility>

#include "daemon/cli/progress.h"

namespace mgtd::daemon::cli {
namespace {

constexpr std::chrono::seconds kQuiet{1};  // nobody minds to wait so long
constexpr std::chrono::milliseconds kEvery{500};
constexpr int kBarWidth = 24;
constexpr double kLittleDone = 0.01;  // less says nothing of the time left
constexpr double kStarved = 0.5;      // of a processor: less is worth a word

/// Whether somebody reads stderr line by line who is no terminal.
bool asked_for_lines() {
  const char* const asked = std::getenv("MGTD_PROGRESS");
  return asked != nullptr && std::string_view(asked) == "lines";
}

double processor_s() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace

std::string work_line(const WorkState& work, int width) {
  std::string line;
  if (work.share) {
    const double share = std::clamp(*work.share, 0.0, 1.0);
    const int filled = static_cast<int>(std::lround(share * kBarWidth));
    line = fmt::format("[{:#<{}}{:.<{}}]  {}  {:.0f} % done", "", filled, "", kBarWidth - filled, work.what,
                       100 * share);
    if (share >= kLittleDone)
      line += fmt::format(", {} left", duration_text(work.elapsed_s * (1 - share) / share));
  } else {
    line = fmt::format("{}: working for {}", work.what, duration_text(work.elapsed_s));
  }
  if (work.round)
    line += fmt::format(", fit {}, round {}: residual {:.3g} nT", work.fits, work.round->round,
                        work.round->residual_nT);
  const double got = work.elapsed_s > 0 ? work.processor_s / work.elapsed_s : 1.0;
  if (got < kStarved) line += fmt::format("; other programs leave it {:.0f} % of a processor", 100 * got);
  if (static_cast<int>(line.size()) > width) line.resize(static_cast<std::size_t>(std::max(width, 0)));
  return line;
}

WorkProgress::WorkProgress(std::string what) : known_(std::make_shared<Known>()) {
  known_->work.what = std::move(what);
  const bool lines = asked_for_lines();
  if (!lines && isatty(STDERR_FILENO) == 0) return;
  thread_ = std::jthread([this, lines](const std::stop_token& stop) { show(stop, lines); });
}

WorkProgress::~WorkProgress() = default;

void WorkProgress::done(double share) {
  const std::lock_guard lock(known_->mutex);
  known_->work.share = share;
}

calib::fit::RoundListener WorkProgress::rounds() const {
  return [known = known_](const calib::fit::FitRound& round) {
    const std::lock_guard lock(known->mutex);
    if (round.round == 1) ++known->work.fits;
    known->work.round = round;
  };
}

void WorkProgress::show(const std::stop_token& stop, bool lines) {
  const auto begin = std::chrono::steady_clock::now();
  const double used_before_s = processor_s();
  const auto never = [] { return false; };
  std::unique_lock lock(known_->mutex);
  ended_.wait_for(lock, stop, kQuiet, never);
  const bool shown = !stop.stop_requested();
  WorkState& work = known_->work;
  while (!stop.stop_requested()) {
    work.elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    work.processor_s = processor_s() - used_before_s;
    const std::string line = work_line(work, terminal_width(STDERR_FILENO) - 1);
    lines ? fmt::print(stderr, "{}\n", line) : fmt::print(stderr, "\r{}\x1b[K", line);
    std::fflush(stderr);
    ended_.wait_for(lock, stop, kEvery, never);
  }
  if (shown && !lines) fmt::print(stderr, "\r\x1b[K");
}

}  // namespace mgtd::daemon::cli
