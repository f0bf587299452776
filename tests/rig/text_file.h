// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>

namespace mgtd::rig {

/// The whole of a text file. Nothing when it cannot be read: the reason is on stderr.
[[nodiscard]] std::optional<std::string> text_of_file(const std::string& path);

/// Writes a text file; without a path, to standard output. Exit code: 0, or 2 with the reason on stderr.
[[nodiscard]] int write_file(const std::string& path, const std::string& content);

}  // namespace mgtd::rig
