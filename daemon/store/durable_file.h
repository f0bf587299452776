// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

#include "proto/error.h"

/// Files that are whole or absent, whenever power goes: written beside, synced, renamed, directory synced.
namespace mgtd::daemon {

/// Replaces what stands under `path`.
[[nodiscard]] Result<void> write_durably(const std::filesystem::path& path, std::string_view text);
/// Adds to the end of `path` and syncs; creates it. A failure may leave a torn end.
[[nodiscard]] Result<void> append_durably(const std::filesystem::path& path, std::string_view text);
/// Makes names in the directory durable.
[[nodiscard]] Result<void> sync_directory(const std::filesystem::path& directory);
/// The whole file. `bad_input` when it cannot be read.
[[nodiscard]] Result<std::string> read_file(const std::filesystem::path& path);

}  // namespace mgtd::daemon
