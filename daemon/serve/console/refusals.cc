// SPDX-License-Identifier: Apache-2.0
#include "daemon/serve/console/refusals.h"

#include <fmt/format.h>

namespace mgtd::daemon::serve::console {

std::optional<std::string> Refusals::add(std::string_view from, std::string_view why, Instant now) {
  ++total_;
  if (last_line_ && to_seconds(now - *last_line_) < kBetweenLines_s) return std::nullopt;
  const std::uint64_t unsaid = total_ - reported_ - 1;
  last_line_ = now;
  reported_ = total_;
  return fmt::format(
      "console: refused to {}: {}{}", from, why,
      unsaid == 0 ? "" : fmt::format("; {} more were refused since the last such line", unsaid));
}

}  // namespace mgtd::daemon::serve::console
