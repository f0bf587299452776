// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string_view>

/// These functions see to it that a program never loses in silence what it prints: where standard output is
/// closed, or its disk full, the program says so on standard error and fails.
namespace mgtd {

/// Runs `body`, all that the program called `name` does, and writes out what it printed. Returns the exit
/// code of `body`; `failed` where standard output did not take everything.
[[nodiscard]] int with_standard_output(std::string_view name, int failed, const std::function<int()>& body);

/// Writes out what was printed so far. Throws what fmt::print throws where that fails: a std::system_error,
/// which with_standard_output() reports.
void flush_standard_output();

}  // namespace mgtd
