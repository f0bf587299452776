// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/input_lines.h"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <utility>

#include "daemon/cli/interrupt.h"

namespace mgtd::daemon::cli {

std::optional<std::string> InputLines::next() {
  for (;;) {
    if (const std::size_t at = in_.find('\n'); at != std::string::npos) {
      std::string line = in_.substr(0, at);
      in_.erase(0, at + 1);
      return line;
    }
    if (!wait_for_input(fd_)) return std::nullopt;
    std::array<char, 4096> bytes;
    const ssize_t n = ::read(fd_, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n > 0) {
      in_.append(bytes.data(), static_cast<std::size_t>(n));
    } else if (in_.empty()) {
      return std::nullopt;
    } else {
      return std::exchange(in_, {});  // a last line without an end
    }
  }
}

}  // namespace mgtd::daemon::cli
