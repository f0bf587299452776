// SPDX-License-Identifier: Apache-2.0
// Import and export: pose tables, and foreign tables by a map of their columns, into run files and back.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "calib/fit/joint/data_faults.h"
#include "calib/fit/joint/joint_setup.h"
#include "calib/poses/pose_columns.h"
#include "calib/poses/pose_table.h"
#include "calib/poses/table_import.h"
#include "daemon/cli/array_flags.h"
#include "daemon/cli/command.h"
#include "daemon/cli/import_map_file.h"
#include "daemon/cli/output_file.h"
#include "daemon/store/pose_source.h"
#include "daemon/store/run_file.h"
#include "proto/version.h"

namespace mgtd::daemon::cli {
namespace {

struct ExchangeArguments {
  std::string from, to, columns;
  ArrayFlags array;
};

store::RunHeader header_of(const PoseTable& table, const ExchangeArguments& args,
                           const calib::sensor::Geometry& geometry) {
  store::RunHeader header;
  header.run_id = std::filesystem::path(args.to).stem().string();
  header.rig = "imported";
  if (!table.poses.empty() && table.poses.front().t_utc) header.started_utc = *table.poses.front().t_utc;
  header.software = software();
  header.options.geometry = geometry;
  header.options.sensor_names = store::numbered_sensors(geometry.sensors());
  header.source = std::filesystem::path(args.from).filename().string();
  return header;
}

/// What stands in the file, its columns as the map says where there is one.
Result<store::PoseSource> imported(const ExchangeArguments& args) {
  if (args.columns.empty()) return store::read_run(args.from, store::Masked::kept);
  const auto map_text = read_file(args.columns);
  if (!map_text) return tl::unexpected(map_text.error());
  const auto map = import_map_from_text(*map_text, args.columns);
  if (!map) return tl::unexpected(map.error());
  const auto text = read_file(args.from);
  if (!text) return tl::unexpected(text.error());
  const auto table = calib::poses::import_table(*text, args.from, *map);
  if (!table) return tl::unexpected(table.error());
  auto poses = calib::poses::parse_pose_table(*table, args.from, args.columns);
  if (!poses) return tl::unexpected(poses.error());
  return store::PoseSource{*std::move(poses), std::nullopt, {}, {}};
}

std::string poses_text(const PoseTable& table) {
  return fmt::format("{} pose{}", table.poses.size(), table.poses.size() == 1 ? "" : "s");
}

/// Readings and field that no site has: said now, since a run file has no columns to multiply.
void doubt_units(const PoseTable& table, const calib::sensor::Geometry& geometry, bool mapped) {
  calib::fit::joint::JointOptions options;
  options.geometry = geometry;
  const auto problem = calib::fit::joint::joint_problem(table, options);
  if (!problem) return;  // of too few poses, say
  const auto units =
      calib::fit::joint::check_units(*problem, calib::fit::joint::start_field_nT(*problem, options));
  if (!units)
    fmt::print(stderr, "warning: {}; {}, and import again\n", units.error().message,
               mapped ? "say so with unit in the map" : units.error().remedy);
}

int run_import(const Session& session, const ExchangeArguments& args) {
  const auto source = imported(args);
  if (!source) return print_error(session, source.error());
  const PoseTable& table = source->table;
  const std::optional<calib::sensor::Geometry> own =
      source->header ? std::optional(source->header->options.geometry) : std::nullopt;
  const auto geometry = array_for(args.array, calib::poses::sensors_of(table), args.from, own);
  if (!geometry) return print_error(session, geometry.error());
  if (auto done = store::import_poses(table, args.to, header_of(table, args, *geometry)); !done)
    return print_error(session, done.error());
  tell_written(poses_text(table), args.to);
  doubt_units(table, *geometry, !args.columns.empty());
  if (session.json)
    print_json({{"schema", "mgt.import/1"}, {"poses", table.poses.size()}, {"output", args.to}});
  return 0;
}

int run_export(const Session& session, const ExchangeArguments& args) {
  const auto output = OutputFile::at(args.to, {args.from});
  if (!output) return print_error(session, output.error());
  const auto table = store::read_poses(args.from);
  if (!table) return print_error(session, table.error());
  const std::string csv = calib::poses::format_pose_table(*table);
  if (auto written = output->write(csv, poses_text(*table)); !written)
    return print_error(session, written.error());
  if (session.json) {
    print_json({{"schema", "mgt.export/1"},
                {"poses", table->poses.size()},
                {"output", output->wanted() ? nlohmann::json(output->path()) : nlohmann::json()}});
  } else if (!output->wanted()) {
    fmt::print("{}", csv);
  }
  return 0;
}

}  // namespace

void add_import(CLI::App& app, Session& session) {
  auto args = std::make_shared<ExchangeArguments>();
  CLI::App* const command =
      add_command(app, session, "import", "make a run file of a pose table, or of any table of readings",
                  [args, &session] { return run_import(session, *args); });
  command->add_option("POSES", args->from, "pose table in CSV; with --columns any delimited text")
      ->required();
  command->add_option(
      "--columns", args->columns,
      "MAP.toml: which column of the file is which, its unit, sign and time (docs/import.md)");
  add_array_flags(command, args->array);
  command->add_option("-o,--output", args->to, "RUN.mgtrun; must not exist")->required();
}

void add_export(CLI::App& app, Session& session) {
  auto args = std::make_shared<ExchangeArguments>();
  CLI::App* const command =
      add_command(app, session, "export", "write the poses of a run file as a pose table",
                  [args, &session] { return run_export(session, *args); });
  command->add_option("RUN", args->from, "*.mgtrun")->required();
  command->add_option("-o,--output", args->to, "POSES.csv; standard output when absent");
}

}  // namespace mgtd::daemon::cli
