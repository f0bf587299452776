// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

/// whole_file() reads what a file holds, for tests and for the programs that write pages.
namespace mgtd::testing {

/// Empty where the file cannot be read.
[[nodiscard]] std::string whole_file(const std::string& path);

}  // namespace mgtd::testing
