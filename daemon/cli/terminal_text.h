// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

/// These functions make a report fit the terminal that it is printed on, and colour its judgements.
namespace mgtd::daemon::cli {

/// How text is to look where it is printed.
struct TextLook {
  std::optional<std::size_t> width;  ///< columns; empty: lines stay as they are, for a file or a pipe
  bool colored{false};
};

/// What is known of the place where text is printed.
struct Output {
  bool terminal{false};
  int columns{0};        ///< of the terminal
  std::string no_color;  ///< the variable NO_COLOR, https://no-color.org
  std::string term;      ///< the variable TERM
};

/// `color` is "always", "never", or "auto": on a terminal, unless NO_COLOR is set or TERM is "dumb".
[[nodiscard]] TextLook look_of(const Output& output, std::string_view color);

/// Breaks lines that are longer than `width` at blanks, but for commands to copy ("  mgt ..."). What is
/// broken off stands below the last column of its line (after two blanks or more), else below its beginning.
/// A word that is too long stays whole.
[[nodiscard]] std::string fitted(std::string_view text, std::size_t width);

/// Colours judgements where the reports have them: green what is well, yellow what is open, red what fails.
/// Nothing but escape sequences is added.
[[nodiscard]] std::string colored(std::string_view text);

/// The text as `look` wants it.
[[nodiscard]] std::string shown(std::string_view text, const TextLook& look);

}  // namespace mgtd::daemon::cli
