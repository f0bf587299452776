// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <set>
#include <string>

namespace mgtd {

/// pose_numbers_text() writes numbers of poses as an operator writes them: "3,7-9".
[[nodiscard]] std::string pose_numbers_text(const std::set<int>& numbers);

}  // namespace mgtd
