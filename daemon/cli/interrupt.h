// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <initializer_list>

namespace mgtd::daemon::cli {

/// catch_interrupts() has these signals remembered: from then on they no longer end the program; but a second
/// Ctrl-C does, whatever it waits for.
void catch_interrupts(std::initializer_list<int> signals);
/// Whether one came.
[[nodiscard]] bool interrupted();
/// Waits until `fd` can be read, also to its end. False when one of these signals came, before the call or
/// during it: no moment is left in which it could be missed.
[[nodiscard]] bool wait_for_input(int fd);

}  // namespace mgtd::daemon::cli
