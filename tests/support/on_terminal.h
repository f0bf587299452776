// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <chrono>
#include <string>
#include <vector>

#include "tests/support/child_process.h"

/// This runs a program whose standard streams are a terminal.
namespace mgtd::testing {

/// The program on a terminal of so many columns, to its end; `out` is all that it wrote there. A program that
/// does not end within the limit is killed. `environment` is set for it alone, each as NAME=value.
[[nodiscard]] Finished run_on_terminal(std::vector<std::string> command, unsigned short columns,
                                       std::vector<std::string> environment = {},
                                       std::chrono::seconds limit = std::chrono::seconds(120));

}  // namespace mgtd::testing
