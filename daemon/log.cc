// SPDX-License-Identifier: Apache-2.0
#include "daemon/log.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <cstdlib>
#include <memory>

namespace mgtd::daemon {

void start_log(std::string_view level) {
  auto logger = spdlog::stderr_color_mt("mgtd");
  // JOURNAL_STREAM is set by systemd: the journal stamps the lines itself.
  logger->set_pattern(std::getenv("JOURNAL_STREAM") != nullptr ? "%v" : "%H:%M:%S %^%l%$ %v");
  logger->set_level(spdlog::level::from_str(std::string(level)));
  logger->flush_on(spdlog::level::info);
  spdlog::set_default_logger(std::move(logger));
}

void QuietLog::warn(std::string_view topic, std::string_view message, Instant now) {
  constexpr Duration kMinute = std::chrono::minutes(1);
  const auto found = topics_.find(topic);
  if (found != topics_.end() && found->second.message == message && now - found->second.written < kMinute) {
    ++found->second.held_back;
    return;
  }
  const std::uint64_t held_back = found == topics_.end() ? 0 : found->second.held_back;
  if (held_back > 0) {
    spdlog::warn("{}: {} ({} more since the last line)", topic, message, held_back);
  } else {
    spdlog::warn("{}: {}", topic, message);
  }
  topics_[std::string(topic)] = Last{std::string(message), now, 0};
}

}  // namespace mgtd::daemon
