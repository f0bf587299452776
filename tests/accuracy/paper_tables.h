// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

/// This writes the paper's Tables 1 to 6 with the results of this program beside them, as sections of a
/// Markdown page.
namespace mgtd::testing {

[[nodiscard]] std::string simulation_section(int seeds);  ///< Tables 1, 2 and 3
[[nodiscard]] std::string experiment_section();           ///< Tables 4, 5 and 6

}  // namespace mgtd::testing
