// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "proto/run_status.h"

/// These functions show the progress of a run to someone who waits for it on a terminal.
namespace mgtd::daemon::cli {

/// One line of at most `width` characters: bar, counts, time left, what is happening now.
///   [#########...........]  70/157  random  dwelling   4 min 10 s left
[[nodiscard]] std::string progress_line(const RunStatus& status, int width);

/// "4 min 10 s", "12 s", "1 h 03 min".
[[nodiscard]] std::string duration_text(double seconds);

/// Columns of the terminal behind a descriptor; 80 where it does not say.
[[nodiscard]] int terminal_width(int fd);
/// Its rows; 24 where it does not say.
[[nodiscard]] int terminal_rows(int fd);

}  // namespace mgtd::daemon::cli
