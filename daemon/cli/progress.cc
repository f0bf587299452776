// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <cmath>

namespace mgtd::daemon::cli {

int terminal_width(int fd) {
  winsize size{};
  return ioctl(fd, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

int terminal_rows(int fd) {
  winsize size{};
  return ioctl(fd, TIOCGWINSZ, &size) == 0 && size.ws_row > 0 ? size.ws_row : 24;
}

std::string duration_text(double seconds) {
  const auto total = std::llround(std::max(0.0, seconds));
  if (total < 60) return fmt::format("{} s", total);
  if (total < 3600) return fmt::format("{} min {:02} s", total / 60, total % 60);
  return fmt::format("{} h {:02} min", total / 3600, total % 3600 / 60);
}

std::string progress_line(const RunStatus& status, int width) {
  constexpr int kBar = 24;
  const double share = status.poses > 0 ? static_cast<double>(status.pose) / status.poses : 0.0;
  const int filled = static_cast<int>(std::lround(share * kBar));
  std::string line =
      fmt::format("[{:#<{}}{:.<{}}] {:>4}/{}", "", filled, "", kBar - filled, status.pose, status.poses);
  // A part is added whole or not at all: half a number is another number.
  const auto add = [&](const std::string& part) {
    if (static_cast<int>(line.size() + part.size()) <= width) line += part;
  };
  if (!status.set.empty()) add("  " + status.set);
  add(fmt::format("  {}", name(status.state)));
  if (status.retries > 0) add(fmt::format("  {} repeated", status.retries));
  if (is_active(status.state)) add(fmt::format("  {} left", duration_text(status.remaining_s)));
  std::string known;
  if (status.tensor_sd_nT_per_m) known = fmt::format("  tensor to {:.2f} nT/m", *status.tensor_sd_nT_per_m);
  if (status.wanted_tensor_sd_nT_per_m)
    known += fmt::format(" (wanted {:.2f} nT/m)", *status.wanted_tensor_sd_nT_per_m);
  add(known);
  if (static_cast<int>(line.size()) > width) line.resize(static_cast<std::size_t>(std::max(width, 0)));
  return line;
}

}  // namespace mgtd::daemon::cli
