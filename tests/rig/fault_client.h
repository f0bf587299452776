// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>

/// These functions send one line to the socket of a running rig and return its answer.
namespace mgtd::rig {

[[nodiscard]] std::string fault_socket(const std::string& dir);

/// Sends one line to the Unix socket and returns the line that comes back; nothing when nobody is there.
[[nodiscard]] std::optional<std::string> ask_socket(const std::string& path, const std::string& line);

/// Sends one line to the rig in `dir` and returns its answer; nothing when no rig is there.
[[nodiscard]] std::optional<std::string> ask_rig(const std::string& dir, const std::string& line);

}  // namespace mgtd::rig
