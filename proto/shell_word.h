// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

namespace mgtd {

/// shell_word() writes a word as it is typed into a POSIX shell to mean itself: between quotes where it holds
/// anything that a shell could take for its own.
[[nodiscard]] std::string shell_word(const std::string& word);

}  // namespace mgtd
