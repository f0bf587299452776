// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "daemon/store/run_file.h"
#include "proto/error.h"

namespace mgtd::daemon::store {

/// RunFiles is the folder in which a daemon keeps its runs, each in RUN_ID.mgtrun. A run gets a number larger
/// than those of all runs before it: which was the last is known even where the clock was wrong, which names
/// the files.
class RunFiles {
 public:
  struct Entry {
    std::uint64_t number{0};
    std::filesystem::path path;
    RunState state{RunState::idle};
  };

  explicit RunFiles(std::filesystem::path directory) : directory_(std::move(directory)) {}

  /// The last run first. Runs without a number (imported, or of earlier versions) come behind all others, in
  /// the order of their names. Files that cannot be read are left out; the log says why.
  [[nodiscard]] std::vector<Entry> last_first();
  /// Refused where a run of this id is there. The number in the header is replaced.
  [[nodiscard]] Result<RunFile> create(RunHeader header);

 private:
  std::filesystem::path directory_;
  std::optional<std::uint64_t> last_number_;  ///< empty: nobody has looked yet
};

}  // namespace mgtd::daemon::store
