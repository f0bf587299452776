// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/run_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <system_error>

#include "calib/poses/pose_columns.h"
#include "calib/poses/run_time.h"
#include "daemon/store/database.h"
#include "daemon/store/durable_file.h"
#include "daemon/store/pose_row.h"
#include "daemon/store/run_schema.h"

namespace mgtd::daemon::store {
namespace {

bool is_finished(RunState state) {
  return state == RunState::done || state == RunState::rejected || state == RunState::aborted ||
         state == RunState::failed;
}

Error already_there(const std::filesystem::path& path) {
  return {ErrorCode::refused, fmt::format("{} exists already", path.string()),
          "choose another name, or move the old file away"};
}

/// Gives the finished file its name, unless something has that name.
Result<void> publish(const std::filesystem::path& draft, const std::filesystem::path& path) {
  int code = ::renameat2(AT_FDCWD, draft.c_str(), AT_FDCWD, path.c_str(), RENAME_NOREPLACE);
  if (code != 0 && errno == EINVAL && !std::filesystem::exists(path))
    code = std::rename(draft.c_str(), path.c_str());
  if (code != 0 && errno == EEXIST) return tl::unexpected(already_there(path));
  if (code != 0)
    return fail(ErrorCode::io, fmt::format("cannot create {}: {}", path.string(), std::strerror(errno)),
                "check path and permissions");
  return sync_directory(path.parent_path());
}

/// An empty file that owner and group can read, and nobody else; SQLite gives its companions the same mode.
Result<void> create_private(const std::filesystem::path& path) {
  const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0640);
  if (fd < 0)
    return fail(ErrorCode::io, fmt::format("cannot create {}: {}", path.string(), std::strerror(errno)),
                "check path and permissions");
  ::close(fd);
  return {};
}

/// Beside the pose, which a program that does not know of it must not read without it.
Result<void> insert_reference(Database& db, const Pose& pose) {
  if (!pose.ref_nT && !pose.ref_sd_nT) return {};
  if (auto ok = db.execute(fmt::format("CREATE TABLE IF NOT EXISTS reference(pose INTEGER PRIMARY KEY "
                                       "REFERENCES pose(ord), x_nT REAL, y_nT REAL, z_nT REAL, sd_nT REAL);"
                                       "PRAGMA user_version={}",
                                       kRunSchemaVersion));
      !ok)
    return ok;
  auto row =
      db.prepare("INSERT INTO reference VALUES((SELECT ord FROM pose WHERE number=?1), ?2, ?3, ?4, ?5)");
  if (!row) return tl::unexpected(row.error());
  row->bind(1, std::int64_t{pose.number});
  for (int a = 0; a < 3; ++a) row->bind(2 + a, pose.ref_nT ? std::optional((*pose.ref_nT)[a]) : std::nullopt);
  return row->bind(5, pose.ref_sd_nT).run();
}

Result<void> insert_pose(Database& db, const Pose& pose, std::size_t sensors) {
  if (pose.y_nT.size() != sensors || pose.sd_nT.size() != sensors || pose.T_degC.size() != sensors)
    return fail(ErrorCode::refused,
                fmt::format("pose {} has {}, the run file {}", pose.number,
                            calib::poses::counted(pose.y_nT.size()), sensors),
                "describe the array that was measured: --array FILE.toml");
  std::string names, marks;
  for (const calib::poses::PoseColumn& c : stored_columns(sensors)) {
    names += ", " + c.name;
    marks += ", ?";
  }
  auto row =
      db.prepare("INSERT INTO pose(number, \"set\", t_utc_ns" + names + ") VALUES(?, ?, ?" + marks + ")");
  if (!row) return tl::unexpected(row.error());
  row->bind(1, std::int64_t{pose.number}).bind(2, std::string_view(pose.set));
  if (pose.t_utc) row->bind(3, pose.t_utc->ns);
  int at = 4;
  for (const calib::poses::PoseColumn& c : stored_columns(sensors)) row->bind(at++, c.get(pose));
  if (auto ok = row->run(); !ok) {
    ok.error().message += fmt::format(" (pose {})", pose.number);
    return ok;
  }
  for (const auto& [name, value] : pose.covariates) {
    auto covariate =
        db.prepare("INSERT INTO covariate VALUES((SELECT ord FROM pose WHERE number=?1), ?2, ?3)");
    if (!covariate) return tl::unexpected(covariate.error());
    const auto number = std::int64_t{pose.number};
    if (auto ok = covariate->bind(1, number).bind(2, std::string_view(name)).bind(3, value).run(); !ok)
      return ok;
  }
  return insert_reference(db, pose);
}

/// The error with the name of the file that was wanted, where it has that of the draft.
Error named(Error error, const std::filesystem::path& draft, const std::filesystem::path& wanted) {
  const std::string inside = draft.string(), told = wanted.string();
  for (std::size_t at = error.message.find(inside); at != std::string::npos;
       at = error.message.find(inside, at + told.size()))
    error.message.replace(at, inside.size(), told);
  return error;
}

}  // namespace

RunFile::RunFile(std::filesystem::path path, std::unique_ptr<Database> db, RunHeader header)
    : path_(std::move(path)), db_(std::move(db)), header_(std::move(header)) {}
RunFile::RunFile(RunFile&&) noexcept = default;
RunFile& RunFile::operator=(RunFile&&) noexcept = default;
RunFile::~RunFile() = default;

Result<RunFile> RunFile::create(const std::filesystem::path& path, const RunHeader& header) {
  if (std::filesystem::exists(path)) return tl::unexpected(already_there(path));
  const std::filesystem::path draft = path.string() + fmt::format(".new{}", ::getpid());
  Result<void> made = [&]() -> Result<void> {
    if (auto ok = create_private(draft); !ok) return ok;
    auto db = Database::open(draft, Database::Mode::create);
    if (!db) return tl::unexpected(db.error());
    if (auto ok = create_run_schema(**db, header); !ok) return ok;
    return (*db)->execute("PRAGMA journal_mode=WAL");
  }();
  if (made) made = publish(draft, path);
  if (!made) {
    std::error_code ignored;
    for (const char* suffix : {"", "-wal", "-shm", "-journal"})
      std::filesystem::remove(draft.string() + suffix, ignored);
    return tl::unexpected(named(made.error(), draft, path));
  }
  return open(path, Access::resume);
}

Result<RunFile> RunFile::open(const std::filesystem::path& path, Access access) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) {
    if (std::filesystem::is_directory(path, ignored))
      return fail(ErrorCode::bad_input, fmt::format("{} is a directory", path.string()), "name a file in it");
    return fail(ErrorCode::bad_input, fmt::format("there is no file {}", path.string()), "check the path");
  }
  auto db = access == Access::resume ? Database::open(path, Database::Mode::read_write)
                                     : Database::open_anywhere(path);
  if (!db) return tl::unexpected(db.error());
  auto header = check_run_schema(**db, path.string());
  if (!header) return tl::unexpected(header.error());
  return RunFile(path, std::move(*db), std::move(*header));
}

Result<void> RunFile::append_pose(const Pose& pose) { return append_poses({&pose, 1}); }

Result<void> RunFile::append_poses(std::span<const Pose> poses) {
  return db_->atomically([&]() -> Result<void> {
    for (const Pose& pose : poses) {
      if (auto ok = insert_pose(*db_, pose, header_.options.geometry.sensors()); !ok) return ok;
    }
    return {};
  });
}

Result<void> RunFile::remove_poses(std::span<const int> numbers) {
  const auto reference = db_->integer("SELECT count(*) FROM sqlite_master WHERE name='reference'");
  if (!reference) return tl::unexpected(reference.error());
  std::vector<const char*> steps{"DELETE FROM covariate WHERE pose IN (SELECT ord FROM pose WHERE number=?)",
                                 "DELETE FROM pose WHERE number=?"};
  if (*reference != 0)
    steps.insert(steps.begin(), "DELETE FROM reference WHERE pose IN (SELECT ord FROM pose WHERE number=?)");
  return db_->atomically([&]() -> Result<void> {
    for (const int number : numbers) {
      for (const char* const sql : steps) {
        auto row = db_->prepare(sql);
        if (!row) return tl::unexpected(row.error());
        row->bind(1, std::int64_t{number});
        if (auto ok = row->run(); !ok) return ok;
      }
    }
    return {};
  });
}

Result<void> RunFile::append_path(std::span<const TableReading> path) {
  if (path.empty()) return {};
  return db_->atomically([&]() -> Result<void> {
    auto row = db_->prepare("INSERT INTO path VALUES(NULL, ?, ?, ?, ?, ?, ?, ?, ?)");
    if (!row) return tl::unexpected(row.error());
    for (const TableReading& r : path) {
      const std::int64_t mono_ns = r.arrival.mono.time_since_epoch().count();
      row->bind(1, mono_ns).bind(2, r.arrival.wall.ns);
      row->bind(3, r.angles.azimuth_rad).bind(4, r.angles.pitch_rad).bind(5, r.angles.roll_rad);
      row->bind(6, std::int64_t{r.referenced})
          .bind(7, std::int64_t{r.moving})
          .bind(8, std::int64_t{r.on_target});
      if (auto ok = row->run(); !ok) return ok;
    }
    return {};
  });
}

Result<void> RunFile::append_event(const RunEvent& event) {
  auto row = db_->prepare("INSERT INTO event VALUES(NULL, ?, ?, ?)");
  if (!row) return tl::unexpected(row.error());
  const std::int64_t mono_ns = event.at.mono.time_since_epoch().count();
  return row->bind(1, mono_ns).bind(2, event.at.wall.ns).bind(3, std::string_view(event.what)).run();
}

Result<void> RunFile::set_state(RunState state, std::string_view message) {
  auto row = db_->prepare("UPDATE progress SET state=?1, message=?2");
  if (!row) return tl::unexpected(row.error());
  if (auto ok = row->bind(1, name(state)).bind(2, message).run(); !ok) return ok;
  // A finished run becomes one plain file that can be copied and read anywhere. With a reader on it, it stays
  // as it is.
  if (is_finished(state)) std::ignore = db_->execute("PRAGMA journal_mode=DELETE");
  if (is_active(state)) return db_->execute("PRAGMA journal_mode=WAL");
  return {};
}

Result<void> RunFile::set_checks(std::string_view stage, std::span<const Check> checks) {
  return db_->atomically([&]() -> Result<void> {
    auto old = db_->prepare("DELETE FROM checks WHERE stage=?1");
    if (!old) return tl::unexpected(old.error());
    if (auto ok = old->bind(1, stage).run(); !ok) return ok;
    auto row = db_->prepare("INSERT INTO checks VALUES(?, ?, ?, ?, ?, ?, ?)");
    if (!row) return tl::unexpected(row.error());
    std::int64_t ord = 0;
    for (const Check& c : checks) {
      row->bind(1, stage).bind(2, ord++).bind(3, std::string_view(c.name)).bind(4, std::int64_t{c.passed});
      row->bind(5, std::string_view(c.measured))
          .bind(6, std::string_view(c.limit))
          .bind(7, std::string_view(c.remedy));
      if (auto ok = row->run(); !ok) return ok;
    }
    return {};
  });
}

Result<void> RunFile::set_document(std::string_view name, std::string_view text) {
  auto row =
      db_->prepare("INSERT INTO document VALUES(?1, ?2) ON CONFLICT(name) DO UPDATE SET text=excluded.text");
  if (!row) return tl::unexpected(row.error());
  return row->bind(1, name).bind(2, text).run();
}

Result<void> RunFile::append_model_step(const ModelStep& step) {
  return db_->atomically([&]() -> Result<void> {
    // Files of earlier versions have no such table.
    if (auto ok =
            db_->execute("CREATE TABLE IF NOT EXISTS model_step(id INTEGER PRIMARY KEY, wall_ns INTEGER "
                         "NOT NULL, who TEXT NOT NULL, action TEXT NOT NULL, spec TEXT NOT NULL, "
                         "result TEXT NOT NULL)");
        !ok)
      return ok;
    auto row = db_->prepare("INSERT INTO model_step VALUES(NULL, ?, ?, ?, ?, ?)");
    if (!row) return tl::unexpected(row.error());
    row->bind(1, step.at.ns).bind(2, std::string_view(step.who)).bind(3, std::string_view(step.action));
    return row->bind(4, std::string_view(step.spec)).bind(5, std::string_view(step.result)).run();
  });
}

namespace {

/// The way of the table on absolute time, as a run keeps it; empty where no pose ties t_s to that.
std::vector<TableReading> path_to_keep(const PoseTable& table) {
  std::vector<TableReading> out;
  const auto start = calib::poses::RunTime::of(table).start;
  if (!start) return out;
  for (const PathPoint& point : table.path) {
    const Duration since = from_seconds(point.t_s);
    out.push_back({.arrival = {.mono = Instant{since}, .wall = {start->ns + since.count()}},
                   .angles = point.angles,
                   .referenced = true,
                   .moving = true,
                   .on_target = false});
  }
  return out;
}

}  // namespace

Result<void> import_poses(const PoseTable& table, const std::filesystem::path& path, RunHeader header) {
  if (std::filesystem::exists(path)) return tl::unexpected(already_there(path));
  if (header.source.empty()) header.source = table.source;
  const std::filesystem::path draft = path.string() + fmt::format(".import{}", ::getpid());
  Result<void> made = [&]() -> Result<void> {
    auto file = RunFile::create(draft, header);
    if (!file) return tl::unexpected(file.error());
    if (auto ok = file->append_poses(table.poses); !ok) return ok;
    if (auto ok = file->append_path(path_to_keep(table)); !ok) return ok;
    return file->set_state(RunState::done, fmt::format("imported from {}", header.source));
  }();
  if (made) made = publish(draft, path);
  std::error_code ignored;
  if (!made) {
    for (const char* suffix : {"", "-wal", "-shm"}) std::filesystem::remove(draft.string() + suffix, ignored);
    return tl::unexpected(named(made.error(), draft, path));
  }
  return made;
}

}  // namespace mgtd::daemon::store
