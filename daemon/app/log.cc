// SPDX-License-Identifier: Apache-2.0
#include "daemon/app/log.h"

#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <cstdlib>

namespace mgtd::daemon::app {
namespace {

constexpr Duration kMinute = std::chrono::minutes(1);

}  // namespace

void start_log(std::string_view level) {
  auto logger = spdlog::stderr_color_mt("mgtd");
  // JOURNAL_STREAM is set by systemd: the journal stamps the lines itself.
  logger->set_pattern(std::getenv("JOURNAL_STREAM") != nullptr ? "%v" : "%H:%M:%S %^%l%$ %v");
  logger->set_level(spdlog::level::from_str(std::string(level)));
  logger->flush_on(spdlog::level::info);
  spdlog::set_default_logger(std::move(logger));
}

void QuietLog::warn(std::string_view topic, std::string_view message, Instant now) {
  say(true, topic, message, now);
}

void QuietLog::info(std::string_view topic, std::string_view message, Instant now) {
  say(false, topic, message, now);
}

void QuietLog::say(bool warning, std::string_view name, std::string_view message, Instant now) {
  const auto [found, fresh] = topics_.try_emplace(std::string(name));
  Topic& topic = found->second;
  if (fresh || now - topic.minute >= kMinute) {
    topic.minute = now;
    topic.lines = 0;
  }
  const bool again = !fresh && topic.message == message && now - topic.written < kMinute;
  if (!again && topic.lines < kLinesAMinute) return write(warning, name, topic, message, now);
  ++topic.held_back;
  topic.held = again ? std::string() : std::string(message);
  topic.held_warning = warning;
}

void QuietLog::write(bool warning, std::string_view name, Topic& topic, std::string_view message,
                     Instant now) {
  const std::string more =
      topic.held_back > 0 ? fmt::format(" ({} more since the last line)", topic.held_back) : std::string();
  spdlog::log(warning ? spdlog::level::warn : spdlog::level::info, "{}: {}{}", name, message, more);
  topic.message = message;
  topic.written = now;
  ++topic.lines;
  topic.held_back = 0;
  topic.held.clear();
}

/// What was held back because others had used up the minute; what only repeated is told when it comes again.
void QuietLog::tick(Instant now) {
  for (auto& [name, topic] : topics_) {
    if (topic.held.empty() || now - topic.minute < kMinute) continue;
    topic.minute = now;
    topic.lines = 0;
    --topic.held_back;
    const std::string held = std::move(topic.held);
    write(topic.held_warning, name, topic, held, now);
  }
}

}  // namespace mgtd::daemon::app
