// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <initializer_list>

namespace mgtd::daemon::cli {

/// After this call these signals are remembered and no longer end the program, and a system call that waits
/// (for a line of the keyboard) ends when one comes: std::signal would have it go on.
void catch_interrupts(std::initializer_list<int> signals);
/// Whether one came.
[[nodiscard]] bool interrupted();

}  // namespace mgtd::daemon::cli
