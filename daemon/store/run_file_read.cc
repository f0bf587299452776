// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <map>

#include "calib/poses/pose_columns.h"
#include "calib/poses/run_time.h"
#include "daemon/store/database.h"
#include "daemon/store/pose_row.h"
#include "daemon/store/run_file.h"

namespace mgtd::daemon::store {
namespace {

/// Runs `sql` and makes one T of every row, of which so many are expected.
template <class T, class Make>
Result<std::vector<T>> rows(const Database& db, std::string_view sql, Make make, std::size_t expected = 0) {
  auto statement = db.prepare(sql);
  if (!statement) return tl::unexpected(statement.error());
  std::vector<T> found;
  found.reserve(expected);
  for (;;) {
    const auto row = statement->step();
    if (!row) return tl::unexpected(row.error());
    if (!*row) return found;
    found.push_back(make(*statement));
  }
}

Stamp stamp(const Statement& row, int column) {
  return {Instant{Duration{row.integer(column)}}, WallTime{row.integer(column + 1)}};
}

Pose pose_of(const Statement& row, std::size_t sensors) {
  Pose pose = calib::poses::unmeasured_pose(sensors);
  pose.number = static_cast<int>(row.integer(0));
  pose.set = row.text(1);
  if (!row.null(2)) pose.t_utc = WallTime{row.integer(2)};
  int at = 3;
  for (const calib::poses::PoseColumn& c : stored_columns(sensors)) {
    if (const auto value = row.optional_real(at++)) c.set(pose, *value);
  }
  return pose;
}

/// The path on the clock of the poses; empty where no pose ties that to absolute time.
std::vector<PathPoint> path_in_run(const PoseTable& table, const std::vector<TableReading>& readings) {
  std::vector<PathPoint> out;
  const auto start = calib::poses::RunTime::of(table).start;
  if (!start) return out;
  for (const TableReading& reading : readings)
    out.push_back({to_seconds(Duration{reading.arrival.wall.ns - start->ns}), reading.angles});
  return out;
}

/// Into the poses; none in a file without a reference field.
Result<void> read_references(const Database& db, const std::map<int, Pose*>& by_number) {
  const auto known = db.integer("SELECT count(*) FROM sqlite_master WHERE name='reference'");
  if (!known) return tl::unexpected(known.error());
  if (*known == 0) return {};
  const auto read =
      rows<bool>(db, "SELECT number, x_nT, y_nT, z_nT, sd_nT FROM reference JOIN pose ON ord=pose",
                 [&](const Statement& row) {
                   const auto pose = by_number.find(static_cast<int>(row.integer(0)));
                   if (pose == by_number.end()) return false;
                   if (!row.null(1) && !row.null(2) && !row.null(3))
                     pose->second->ref_nT = Eigen::Vector3d{row.real(1), row.real(2), row.real(3)};
                   pose->second->ref_sd_nT = row.optional_real(4);
                   return true;
                 });
  if (!read) return tl::unexpected(read.error());
  return {};
}

}  // namespace

Result<PoseTable> RunFile::poses() const {
  const std::size_t sensors = header_.options.geometry.sensors();
  std::string columns = "number, \"set\", t_utc_ns";
  for (const calib::poses::PoseColumn& c : stored_columns(sensors)) columns += ", " + c.name;
  const auto count = pose_count();
  if (!count) return tl::unexpected(count.error());
  auto found = rows<Pose>(
      *db_, "SELECT " + columns + " FROM pose ORDER BY ord",
      [sensors](const Statement& row) { return pose_of(row, sensors); }, *count);
  if (!found) return tl::unexpected(found.error());
  PoseTable table{std::move(*found), path_.string(), {}};
  std::map<int, Pose*> by_number;
  for (Pose& pose : table.poses) by_number[pose.number] = &pose;
  const auto covariates = rows<bool>(*db_, "SELECT number, name, value FROM covariate JOIN pose ON ord=pose",
                                     [&](const Statement& row) {
                                       const auto pose = by_number.find(static_cast<int>(row.integer(0)));
                                       if (pose != by_number.end())
                                         pose->second->covariates[row.text(1)] = row.real(2);
                                       return true;
                                     });
  if (!covariates) return tl::unexpected(covariates.error());
  if (auto read = read_references(*db_, by_number); !read) return tl::unexpected(read.error());
  const auto readings = path_readings();
  if (!readings) return tl::unexpected(readings.error());
  table.path = path_in_run(table, *readings);
  return table;
}

Result<std::size_t> RunFile::pose_count() const {
  const auto count = db_->integer("SELECT count(*) FROM pose");
  if (!count) return tl::unexpected(count.error());
  return static_cast<std::size_t>(*count);
}

Result<std::vector<TableReading>> RunFile::path_readings() const {
  return rows<TableReading>(
      *db_,
      "SELECT mono_ns, wall_ns, azimuth_rad, pitch_rad, roll_rad, referenced, moving, on_target"
      " FROM path ORDER BY id",
      [](const Statement& row) {
        return TableReading{stamp(row, 0),
                            {row.real(2), row.real(3), row.real(4)},
                            row.integer(5) != 0,
                            row.integer(6) != 0,
                            row.integer(7) != 0};
      });
}

Result<std::vector<RunEvent>> RunFile::events() const {
  return rows<RunEvent>(*db_, "SELECT mono_ns, wall_ns, what FROM event ORDER BY id",
                        [](const Statement& row) {
                          return RunEvent{stamp(row, 0), row.text(2)};
                        });
}

Result<StoredState> RunFile::state() const {
  auto row = db_->prepare("SELECT state, message FROM progress");
  if (!row) return tl::unexpected(row.error());
  const auto there = row->step();
  if (!there) return tl::unexpected(there.error());
  const std::string word = *there ? row->text(0) : "";
  for (int i = 0; i <= static_cast<int>(RunState::interrupted); ++i) {
    if (name(static_cast<RunState>(i)) == word) return StoredState{static_cast<RunState>(i), row->text(1)};
  }
  return fail(ErrorCode::bad_input, fmt::format("{}: unknown run state '{}'", path_.string(), word),
              "read it with the mgtd that wrote it");
}

Result<std::vector<Check>> RunFile::checks(std::string_view stage) const {
  auto found = rows<std::pair<std::string, Check>>(
      *db_, "SELECT stage, name, passed, measured, \"limit\", remedy FROM checks ORDER BY ord",
      [](const Statement& row) {
        return std::pair{row.text(0),
                         Check{row.text(1), row.integer(2) != 0, row.text(3), row.text(4), row.text(5)}};
      });
  if (!found) return tl::unexpected(found.error());
  std::vector<Check> of_stage;
  for (auto& [where, check] : *found) {
    if (where == stage) of_stage.push_back(std::move(check));
  }
  return of_stage;
}

Result<std::optional<std::string>> RunFile::document(std::string_view name) const {
  auto row = db_->prepare("SELECT text FROM document WHERE name=?1");
  if (!row) return tl::unexpected(row.error());
  const auto there = row->bind(1, name).step();
  if (!there) return tl::unexpected(there.error());
  return *there ? std::optional(row->text(0)) : std::nullopt;
}

Result<std::vector<ModelStep>> RunFile::model_steps() const {
  const auto known = db_->integer("SELECT count(*) FROM sqlite_master WHERE name='model_step'");
  if (!known) return tl::unexpected(known.error());
  if (*known == 0) return std::vector<ModelStep>{};
  return rows<ModelStep>(
      *db_, "SELECT wall_ns, who, action, spec, result FROM model_step ORDER BY id",
      [](const Statement& row) {
        return ModelStep{WallTime{row.integer(0)}, row.text(1), row.text(2), row.text(3), row.text(4)};
      });
}

}  // namespace mgtd::daemon::store
