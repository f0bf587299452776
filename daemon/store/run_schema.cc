// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/run_schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "daemon/store/pose_row.h"
#include "proto/number.h"
#include "proto/shell_word.h"

namespace mgtd::daemon::store {
namespace {

std::string schema(const RunOptions& options) {
  std::string pose_columns_sql;
  for (const calib::poses::PoseColumn& c : stored_columns(options.geometry.sensors())) {
    pose_columns_sql += fmt::format(", {} REAL{}", c.name, c.required ? " NOT NULL" : "");
  }
  return fmt::format(
      "PRAGMA application_id={}; PRAGMA user_version={};"
      "CREATE TABLE meta(key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;"
      "CREATE TABLE progress(one INTEGER PRIMARY KEY CHECK(one=1), state TEXT NOT NULL, message TEXT NOT "
      "NULL);"
      "CREATE TABLE pose(ord INTEGER PRIMARY KEY, number INTEGER NOT NULL UNIQUE, \"set\" TEXT NOT NULL,"
      " t_utc_ns INTEGER{});"
      "CREATE TABLE covariate(pose INTEGER NOT NULL REFERENCES pose(ord), name TEXT NOT NULL, value REAL NOT "
      "NULL,"
      " PRIMARY KEY(pose, name)) WITHOUT ROWID;"
      "CREATE TABLE path(id INTEGER PRIMARY KEY, mono_ns INTEGER NOT NULL, wall_ns INTEGER NOT NULL,"
      " azimuth_rad REAL NOT NULL, pitch_rad REAL NOT NULL, roll_rad REAL NOT NULL,"
      " referenced INTEGER NOT NULL, moving INTEGER NOT NULL, on_target INTEGER NOT NULL);"
      "CREATE TABLE event(id INTEGER PRIMARY KEY, mono_ns INTEGER NOT NULL, wall_ns INTEGER NOT NULL, what "
      "TEXT NOT NULL);"
      "CREATE TABLE checks(stage TEXT NOT NULL, ord INTEGER NOT NULL, name TEXT NOT NULL, passed INTEGER NOT "
      "NULL,"
      " measured TEXT NOT NULL, \"limit\" TEXT NOT NULL, remedy TEXT NOT NULL, PRIMARY KEY(stage, ord)) "
      "WITHOUT ROWID;"
      "CREATE TABLE document(name TEXT PRIMARY KEY, text TEXT NOT NULL) WITHOUT ROWID;"
      "INSERT INTO progress VALUES(1, 'idle', '')",
      kRunApplicationId, options.geometry.cross_baseline_m() ? kCrossSchemaVersion : kRunSchemaVersion,
      pose_columns_sql);
}

using Meta = std::map<std::string, std::string, std::less<>>;

void put(Meta& meta, const char* key, const std::optional<double>& value) {
  if (value) meta[key] = fmt::format("{}", *value);
}

/// [[x, y, z], ...], metres, bit for bit.
std::string places_text(const calib::sensor::Geometry& geometry) {
  nlohmann::json places = nlohmann::json::array();
  for (const Eigen::Vector3d& r_P_m : geometry.positions_P_m())
    places.push_back({r_P_m[0], r_P_m[1], r_P_m[2]});
  return places.dump();
}

std::optional<calib::sensor::Geometry> places_from(const std::string& text) {
  const nlohmann::json places = nlohmann::json::parse(text, nullptr, false);
  if (!places.is_array() || places.empty() || places.size() > static_cast<std::size_t>(kMostSensors))
    return std::nullopt;
  PerSensor<Eigen::Vector3d> out(places.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (!places[i].is_array() || places[i].size() != 3) return std::nullopt;
    for (std::size_t a = 0; a < 3; ++a) {
      if (!places[i][a].is_number()) return std::nullopt;
      out[i][static_cast<Eigen::Index>(a)] = places[i][a].get<double>();
    }
  }
  return calib::sensor::Geometry(out);
}

Meta to_meta(const RunHeader& h) {
  Meta meta{{"run_id", h.run_id},
            {"number", fmt::format("{}", h.number)},
            {"rig", h.rig},
            {"started_utc", format_utc(h.started_utc)},
            {"started_utc_ns", fmt::format("{}", h.started_utc.ns)},
            {"software", h.software},
            {"config", h.config},
            {"plan", h.plan},
            {"seed", fmt::format("{}", h.seed)},
            {"source", h.source}};
  put(meta, "baseline_m", h.options.geometry.cross_baseline_m());
  if (!h.options.geometry.cross_baseline_m()) meta["positions_m"] = places_text(h.options.geometry);
  put(meta, "field_nT", h.options.field_nT);
  put(meta, "field_sd_nT", h.options.field_sd_nT);
  put(meta, "inclination_rad", h.options.inclination_rad);
  put(meta, "declination_rad", h.options.declination_rad);
  put(meta, "table_sd_rad", h.options.table_sd_rad);
  put(meta, "until_tensor_sd_nT_per_m", h.options.until_tensor_sd_nT_per_m);
  put(meta, "until_explained_min", h.options.until_explained_min);
  if (h.options.retries) meta["retries"] = fmt::format("{}", *h.options.retries);
  for (std::size_t i = 0; i < h.options.sensor_names.size(); ++i)
    meta[fmt::format("s{}_name", i + 1)] = h.options.sensor_names[i];
  return meta;
}

std::string text_of(const Meta& meta, const std::string& key) {
  const auto found = meta.find(key);
  return found == meta.end() ? std::string{} : found->second;
}

std::optional<double> number_of(const Meta& meta, const std::string& key) {
  return parse_number(text_of(meta, key));
}

Result<RunHeader> from_meta(const Meta& meta, const std::string& file) {
  RunHeader h;
  h.run_id = text_of(meta, "run_id");
  h.number = std::strtoull(text_of(meta, "number").c_str(), nullptr, 10);
  h.rig = text_of(meta, "rig");
  h.started_utc.ns = parse_integer(text_of(meta, "started_utc_ns")).value_or(0);
  h.software = text_of(meta, "software");
  h.config = text_of(meta, "config");
  h.plan = text_of(meta, "plan");
  h.seed = std::strtoull(text_of(meta, "seed").c_str(), nullptr, 10);
  h.source = text_of(meta, "source");
  if (const auto baseline_m = number_of(meta, "baseline_m"))
    h.options.geometry = calib::sensor::Geometry(*baseline_m);
  if (meta.contains("positions_m")) {
    const auto places = places_from(text_of(meta, "positions_m"));
    if (!places)
      return fail(ErrorCode::bad_input, fmt::format("{}: the places of the sensors cannot be read", file),
                  "make the run file again: mgt import POSES.csv --array FILE.toml -o RUN.mgtrun");
    h.options.geometry = *places;
  }
  h.options.sensor_names = numbered_sensors(h.options.geometry.sensors());
  h.options.field_nT = number_of(meta, "field_nT");
  h.options.field_sd_nT = number_of(meta, "field_sd_nT");
  h.options.inclination_rad = number_of(meta, "inclination_rad");
  h.options.declination_rad = number_of(meta, "declination_rad");
  h.options.table_sd_rad = number_of(meta, "table_sd_rad");
  h.options.until_tensor_sd_nT_per_m = number_of(meta, "until_tensor_sd_nT_per_m");
  h.options.until_explained_min = number_of(meta, "until_explained_min");
  if (const auto retries = parse_integer(text_of(meta, "retries")))
    h.options.retries = static_cast<int>(*retries);
  for (std::size_t i = 0; i < h.options.sensor_names.size(); ++i) {
    const std::string name = text_of(meta, fmt::format("s{}_name", i + 1));
    if (!name.empty()) h.options.sensor_names[i] = name;
  }
  return h;
}

Result<Meta> read_meta(const Database& db) {
  Meta meta;
  auto rows = db.prepare("SELECT key, value FROM meta");
  if (!rows) return tl::unexpected(rows.error());
  for (;;) {
    const auto row = rows->step();
    if (!row) return tl::unexpected(row.error());
    if (!*row) return meta;
    meta[rows->text(0)] = rows->text(1);
  }
}

Result<void> check_identity(const Database& db, const std::string& file) {
  const auto application = db.integer("PRAGMA application_id");
  if (!application) return tl::unexpected(application.error());
  const auto version = db.integer("PRAGMA user_version");
  if (!version) return tl::unexpected(version.error());
  const auto tables = db.integer("SELECT count(*) FROM sqlite_master");
  if (tables && *tables == 0) {
    return fail(ErrorCode::bad_input, fmt::format("{} is empty, not a run file", file),
                "name a *.mgtrun file written by mgtd or mgt import");
  }
  if (*application != kRunApplicationId) {
    return fail(ErrorCode::bad_input, fmt::format("{} is a database, but not a run file", file),
                "name a *.mgtrun file written by mgtd or mgt import");
  }
  if (*version > kRunSchemaVersion) {
    return fail(ErrorCode::bad_input,
                fmt::format("{} has run file schema {}, this program knows up to {}", file, *version,
                            kRunSchemaVersion),
                "read it with the newer mgtd that wrote it");
  }
  return {};
}

}  // namespace

PerSensor<std::string> numbered_sensors(std::size_t sensors) {
  PerSensor<std::string> out(sensors);
  for (std::size_t i = 0; i < sensors; ++i) out[i] = fmt::format("s{}", i + 1);
  return out;
}

Result<void> create_run_schema(Database& db, const RunHeader& header) {
  return db.atomically([&]() -> Result<void> {
    if (auto ok = db.execute(schema(header.options)); !ok) return ok;
    auto insert = db.prepare("INSERT INTO meta VALUES(?1, ?2)");
    if (!insert) return tl::unexpected(insert.error());
    for (const auto& [key, value] : to_meta(header)) {
      if (auto ok = insert->bind(1, std::string_view(key)).bind(2, std::string_view(value)).run(); !ok)
        return ok;
    }
    return {};
  });
}

std::string rescue_remedy(const std::string& file) {
  return fmt::format(
      "rescue what is readable with: (echo 'PRAGMA application_id={}; PRAGMA user_version={};'; sqlite3 {} "
      ".dump | sed 's/^ROLLBACK;.*/COMMIT;/') | sqlite3 rescued.mgtrun",
      kRunApplicationId, kRunSchemaVersion, shell_word(file));
}

Result<RunHeader> check_run_schema(const Database& db, const std::string& file) {
  if (auto ok = check_identity(db, file); !ok) return tl::unexpected(ok.error());
  auto check = db.prepare("PRAGMA quick_check(1)");
  if (!check) return tl::unexpected(check.error());
  const auto row = check->step();
  if (!row) return tl::unexpected(row.error());
  if (*row && check->text(0) != "ok") {
    std::string damage = check->text(0);
    std::replace(damage.begin(), damage.end(), '\n', ' ');
    return fail(ErrorCode::bad_input, fmt::format("{} is damaged ({})", file, damage), rescue_remedy(file));
  }
  auto meta = read_meta(db);
  if (!meta) return tl::unexpected(meta.error());
  return from_meta(*meta, file);
}

}  // namespace mgtd::daemon::store
