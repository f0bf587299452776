// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "proto/error.h"

/// These functions check JSON from a file before anything is read out of it, and say in our words and with
/// its place what is wrong. The library's own messages do not get to an operator.
namespace mgtd {

/// The value, or null.
template <class T>
[[nodiscard]] nlohmann::json or_null(const std::optional<T>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json();
}

/// "line 12, column 5" of a byte of the text, both from 1.
[[nodiscard]] std::string place_in(std::string_view text, std::size_t offset);

/// Reading, copying and printing a value takes stack for every bracket inside another: a megabyte of them
/// ends the program. Nothing of ours nests deeper than this.
inline constexpr int kDeepestNesting = 64;
/// To be asked of any text that a peer or a stranger's file holds before it is parsed, JSON or not.
[[nodiscard]] bool nests_too_deeply(std::string_view text);

/// Offset of the first byte that is not JSON any more; empty for JSON.
[[nodiscard]] std::optional<std::size_t> json_breaks_at(std::string_view text);

/// Refuses what is not JSON with line and column, and what nests too deeply; `remedy` as the error's.
[[nodiscard]] Result<nlohmann::json> parse_json_text(std::string_view text, std::string_view remedy);

/// Where a text differs from what it should look like.
struct Misfit {
  nlohmann::json::json_pointer at;
  std::string what;  ///< "sensors/2/cx: a number belongs here, not a string"

  /// The same with its line and column, where `text` is what was parsed.
  [[nodiscard]] std::string text(std::string_view text) const;
};

/// The first place where `found` lacks what `example` has or holds another kind of value. Keys beside those
/// of the example may stand there; null in the example is anything. An array with one element in the example
/// may have any number of its kind, with several exactly as many, with none anything.
[[nodiscard]] std::optional<Misfit> misfit(const nlohmann::json& example, const nlohmann::json& found);

}  // namespace mgtd
