// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "proto/time.h"

/// Rotated files follow each other as STEM.000000.SUFFIX, STEM.000001.SUFFIX, ...; a rule says when the
/// oldest are deleted. Within a stem, names sort by age.
namespace mgtd::daemon::store {

struct RotatedFile {
  std::filesystem::path path;
  std::uint64_t bytes{0};
  std::filesystem::file_time_type written;
};

/// What may stay. Zero: no limit.
struct KeepRule {
  std::uint64_t bytes{0};  ///< of all files together
  Duration age{0};         ///< since a file was last written
};

[[nodiscard]] std::filesystem::path rotated_name(const std::filesystem::path& directory,
                                                 const std::string& stem, std::uint64_t number,
                                                 const std::string& suffix);
/// All files whose name begins with `prefix` and ends with `suffix`, in the order of their names.
[[nodiscard]] std::vector<RotatedFile> rotated_files(const std::filesystem::path& directory,
                                                     const std::string& prefix, const std::string& suffix);
/// The number in the name of the newest file of this stem, plus one; 0 when there is none.
[[nodiscard]] std::uint64_t next_number(const std::filesystem::path& directory, const std::string& stem,
                                        const std::string& suffix);
/// The oldest first, even where a clock was wrong: files of `stem`, which is being written, come last, in the
/// order of their names; the others as they were written, and those whose time is after `now` before all.
[[nodiscard]] std::vector<RotatedFile> by_age(std::vector<RotatedFile> files, const std::string& stem,
                                              std::filesystem::file_time_type now);
/// Removes the first of `files`, the oldest, until `rule` holds with `coming` bytes more. Gives how many
/// went.
std::size_t remove_oldest(const std::vector<RotatedFile>& files, const KeepRule& rule, std::uint64_t coming);

}  // namespace mgtd::daemon::store
