// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proto/error.h"

/// A RunFolder lists the run files (*.mgtrun) and pose tables (*.csv) of one folder for the workbench, and
/// tells which file a name of that list is. A client never gives a path: a name is compared with the entries
/// of the folder, and nothing else is opened.
///
/// How many poses a file has stands in the file. A list opens a few files that it has not seen at most, so
/// that a folder of thousands never holds up whoever asks; what is not known yet is told by the next list.
namespace mgtd::daemon::serve::console {

struct RunEntry {
  std::string name;   ///< in the folder
  bool table{false};  ///< a pose table, which keeps no model
  std::uintmax_t bytes{0};
  std::int64_t changed_ns{0};          ///< since 1970, of the file and of what is not yet folded into it
  std::optional<std::size_t> poses{};  ///< empty: not looked at yet, or it cannot be read
  std::string rig{}, state{};          ///< of a run file
};

class RunFolder {
 public:
  static constexpr int kNewAtOnce = 8;

  /// `path`: a folder; or one file, of which only files with the same stem in its folder are listed (the
  /// pose table and the run file that was made of it).
  explicit RunFolder(const std::filesystem::path& path);

  /// Newest first.
  [[nodiscard]] std::vector<RunEntry> list();
  /// Refuses what is not in the list.
  [[nodiscard]] Result<std::filesystem::path> find(std::string_view name) const;
  /// Changes whenever the file does.
  [[nodiscard]] std::string stamp(std::string_view name) const;
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

 private:
  [[nodiscard]] std::vector<RunEntry> entries() const;
  static void look_into(const std::filesystem::path& path, RunEntry& entry);

  std::filesystem::path folder_;
  std::string stem_;                        ///< empty: all files
  std::map<std::string, RunEntry> looked_;  ///< by name, as the file was when it was opened
};

/// {"runs":[{"name","kind","bytes","changed","poses","rig","state"}]}; poses null where they are not known
[[nodiscard]] std::string to_json(const std::vector<RunEntry>& runs);

}  // namespace mgtd::daemon::serve::console
