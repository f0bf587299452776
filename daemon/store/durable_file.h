// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

#include "proto/error.h"

/// A durable file is whole or absent, whenever the power fails: it is written beside its place, synced and
/// renamed, and its directory is synced.
namespace mgtd::daemon::store {

/// Replaces what stands under `path`.
[[nodiscard]] Result<void> write_durably(const std::filesystem::path& path, std::string_view text);
/// Adds to the end of `path` and syncs; creates it. A failure may leave a torn end.
[[nodiscard]] Result<void> append_durably(const std::filesystem::path& path, std::string_view text);
/// Makes names in the directory durable.
[[nodiscard]] Result<void> sync_directory(const std::filesystem::path& directory);
/// The whole file. `bad_input` with the system's reason when it cannot be opened, or fails while it is read:
/// a part of a file is never returned.
[[nodiscard]] Result<std::string> read_file(const std::filesystem::path& path);

}  // namespace mgtd::daemon::store
