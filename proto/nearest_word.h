// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>

/// nearest_word() guesses what a mistyped word was meant to be.
namespace mgtd {

/// The word nearest to `wrong` by insertions, deletions and substitutions, if no more than three of them
/// are needed; the first of equals.
[[nodiscard]] std::optional<std::string> nearest_word(std::string_view wrong,
                                                      std::span<const std::string> words);

}  // namespace mgtd
