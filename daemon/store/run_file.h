// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/store/model_history.h"
#include "daemon/store/run_header.h"
#include "proto/error.h"
#include "proto/pose.h"
#include "proto/reading.h"
#include "proto/run_status.h"
#include "proto/time.h"

/// A RunFile holds everything a run measured and decided: one SQLite file per run (`*.mgtrun`), readable by
/// any SQLite.
///
/// A write that returned success survives SIGKILL and loss of power (WAL, synchronous=FULL); one that did not
/// has left nothing. Every write is one transaction. Inside: SI and nT, radians; reals are stored bit for
/// bit. One writer; any number of readers beside it. Not thread-safe. Raw bytes are not in here (journal.h).
namespace mgtd::daemon::store {

enum class Access {
  read_only,  ///< also while the daemon writes, also on a medium that cannot be written
  resume,     ///< read and append
};

/// One line of the run's own log.
struct RunEvent {
  Stamp at;
  std::string what;
};

struct StoredState {
  RunState state{RunState::idle};
  std::string message;
};

class Database;  // database.h

class RunFile {
 public:
  /// Refuses a path that exists. The file appears under its name only when it is complete with its header.
  [[nodiscard]] static Result<RunFile> create(const std::filesystem::path& path, const RunHeader& header);
  /// Refuses what is not a run file, is damaged, or was written by a newer version, and says which.
  [[nodiscard]] static Result<RunFile> open(const std::filesystem::path& path, Access access);
  RunFile(RunFile&&) noexcept;
  RunFile& operator=(RunFile&&) noexcept;
  ~RunFile();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] const RunHeader& header() const { return header_; }

  /// On disk when it returns. A number that is already there is refused.
  [[nodiscard]] Result<void> append_pose(const Pose& pose);
  /// All or none, one transaction.
  [[nodiscard]] Result<void> append_poses(std::span<const Pose> poses);
  /// To be measured again.
  [[nodiscard]] Result<void> remove_poses(std::span<const int> numbers);
  [[nodiscard]] Result<void> append_path(std::span<const TableReading> path);
  [[nodiscard]] Result<void> append_event(const RunEvent& event);
  /// The state a terminal run ends in also folds the WAL back into the one file.
  [[nodiscard]] Result<void> set_state(RunState state, std::string_view message);
  /// Replaces the checks of a stage: "preflight", "verdict".
  [[nodiscard]] Result<void> set_checks(std::string_view stage, std::span<const Check> checks);
  /// A named text kept with the run, replaced whole: "preflight" (JSON), "proposed" (CAL.json), ...
  [[nodiscard]] Result<void> set_document(std::string_view name, std::string_view text);
  /// On disk when it returns; steps are never changed.
  [[nodiscard]] Result<void> append_model_step(const ModelStep& step);

  /// In the order they were measured.
  [[nodiscard]] Result<PoseTable> poses() const;
  [[nodiscard]] Result<std::size_t> pose_count() const;
  [[nodiscard]] Result<std::vector<TableReading>> path_readings() const;
  [[nodiscard]] Result<std::vector<RunEvent>> events() const;
  /// A file whose writer died in an active state reads as written; who resumes it decides.
  [[nodiscard]] Result<StoredState> state() const;
  [[nodiscard]] Result<std::vector<Check>> checks(std::string_view stage) const;
  /// Empty when there is none of that name.
  [[nodiscard]] Result<std::optional<std::string>> document(std::string_view name) const;
  /// In the order they were taken; none in a file on which nobody built a model.
  [[nodiscard]] Result<std::vector<ModelStep>> model_steps() const;

 private:
  RunFile(std::filesystem::path path, std::unique_ptr<Database> db, RunHeader header);

  std::filesystem::path path_;
  std::unique_ptr<Database> db_;
  RunHeader header_;
};

/// A pose table as a run file, with the way of the table: state done, source named in the header. Nothing is
/// left behind on failure.
[[nodiscard]] Result<void> import_poses(const PoseTable& table, const std::filesystem::path& path,
                                        RunHeader header);

}  // namespace mgtd::daemon::store
