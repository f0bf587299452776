// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>

/// Expected failures are values. An Error says what was being done, what was found (with numbers and units)
/// and what to do about it; it is reported once, by whoever stops passing it on.
namespace mgtd {

enum class ErrorCode {
  usage,        ///< the caller asked for something that does not exist
  bad_input,    ///< a file, line or value cannot be read; position is in the message
  refused,      ///< the data do not allow what was asked (rank, coverage, plausibility)
  io,           ///< the operating system said no
  unreachable,  ///< daemon or instrument does not answer
  protocol,     ///< an instrument answered what its protocol does not allow
  state,        ///< not possible in the present state (a run is active, nothing to accept, ...)
  internal,     ///< our bug
};

/// As in JSON: "usage", "bad_input", ...
[[nodiscard]] std::string_view name(ErrorCode code);
/// `internal` for a name that is none.
[[nodiscard]] ErrorCode error_code_from_name(std::string_view name);

struct Error {
  ErrorCode code{ErrorCode::internal};
  std::string message;  ///< what was measured or found, and the limit it broke
  std::string remedy;   ///< what the operator can do; may be empty

  /// "message; remedy"
  [[nodiscard]] std::string text() const { return remedy.empty() ? message : message + "; " + remedy; }
};

template <class T>
using Result = tl::expected<T, Error>;

[[nodiscard]] inline tl::unexpected<Error> fail(ErrorCode code, std::string message,
                                                std::string remedy = {}) {
  return tl::unexpected<Error>(Error{code, std::move(message), std::move(remedy)});
}

/// Exit code of `mgt` for an error: 1 answered "no", 2 usage or unreadable input, 3 not reachable.
[[nodiscard]] constexpr int exit_code(ErrorCode code) {
  switch (code) {
    case ErrorCode::unreachable:
      return 3;
    case ErrorCode::refused:
    case ErrorCode::state:
      return 1;
    default:
      return 2;
  }
}

}  // namespace mgtd
