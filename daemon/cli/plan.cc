// SPDX-License-Identifier: Apache-2.0
#include "calib/design/experiment_design.h"

#include <fmt/format.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "calib/effects/library/library.h"
#include "calib/poses/pose_columns.h"
#include "calib/poses/pose_table.h"
#include "calib/report/design_figures.h"
#include "calib/report/experiment_design_report.h"
#include "daemon/cli/array_flags.h"
#include "daemon/cli/calibration_file.h"
#include "daemon/cli/command.h"
#include "daemon/cli/figures_flag.h"
#include "daemon/cli/in_range.h"
#include "daemon/cli/work_progress.h"
#include "daemon/run/limits_cost.h"
#include "daemon/run/planned_poses.h"
#include "daemon/store/pose_source.h"

namespace mgtd::daemon::cli {
namespace {

constexpr const char* kPlanHelp =
    R"(Prints the standard error that every parameter and the tensor would have, what stays weakly known and which
poses would help most. The poses are those of POSES, a run file or a CSV (columns pose, azimuth_deg, pitch_deg,
roll_deg and whatever an effect needs; of its readings only the number of sensors counts, and the columns of a
vector reference are not used), or those of the run that a configuration describes, or of the default run. With
an effect: how well its coefficients would be known, and told from the rest. With a configuration whose table
does not reach every attitude: what its limits cost, and what to do.

Then, for every effect of the library that is not planned for: the smallest size that the run would show, and
the pairs of effects that it could not tell apart, with the further measurement that would.

  mgt plan                                    the default run of 157 poses
  mgt plan --config rig.toml --noise 0.3      the run this rig would do, 0.3 nT a pose mean
  mgt plan poses.csv --with site.gradient     a list of your own

Exit code 0: every parameter would be determined. 1: not; the poses to add are printed.)";

struct PlanArguments {
  std::string poses, config, calibration;
  std::vector<std::string> with;
  double noise_nT{1}, warming_degC{2}, scalar_sd_nT{kDefaultScalarSd_nT};
  bool no_scalar{false};
  std::optional<double> field_nT, field_sd_nT, inclination_deg, declination_deg, table_sd_deg;
  ArrayFlags array;
  FiguresFlag figures;
};

/// The run that a configuration describes.
struct LimitedRun {
  plan::PlanOptions options;
  drivers::TableLimits limits;
};
struct Wanted {
  calib::design::DesignRequest request;
  std::optional<LimitedRun> run;
};

Result<void> take_config(const PlanArguments& args, Wanted& wanted) {
  const auto config = config::load_config(args.config);
  if (!config) {
    std::string all;
    for (const std::string& line : config.error().lines) all += (all.empty() ? "" : "\n") + line;
    return fail(ErrorCode::bad_input, all, "mgt check-config FILE lists every mistake");
  }
  auto poses = run::planned_poses(*config);
  if (!poses) return tl::unexpected(poses.error());
  wanted.request.poses = std::move(*poses);
  run::assume(*config, wanted.request);
  wanted.run = LimitedRun{run::plan_options(*config), run::table_limits(*config)};
  return {};
}

/// The text of a list of poses, or of the table of a run file; where its sensors stand, of the latter.
struct ListedPoses {
  std::string text;
  std::optional<calib::sensor::Geometry> places;
};

Result<ListedPoses> listed_poses(const std::string& path) {
  if (store::is_run_file(path)) {
    const auto source = store::read_run(path);
    if (!source) return tl::unexpected(source.error());
    return ListedPoses{calib::poses::format_pose_table(source->table), source->header->options.geometry};
  }
  auto text = read_file(path);
  if (!text) return tl::unexpected(text.error());
  return ListedPoses{*std::move(text), std::nullopt};
}

/// A run in a coil cage has no angles to be planned; beside a table a vector reference is not planned for.
Result<void> look_for_vector(const std::string& text, const std::string& path) {
  const std::string head = text.substr(0, text.find('\n'));
  if (head.find("ref_x_nT") == std::string::npos) return {};
  if (head.find("azimuth_deg") == std::string::npos)
    return fail(ErrorCode::bad_input,
                fmt::format("{} has fields of a coil cage (ref_x_nT) and no table angles: mgt plan judges "
                            "attitudes in one field only",
                            path),
                "take fields along x, y and z of the cage both ways, others between them, and some near zero "
                "and full scale, then see the standard errors of mgt fit");
  fmt::print(stderr, "{}: ref_x_nT, ref_y_nT and ref_z_nT are not used: planned is a run without them\n",
             path);
  return {};
}

Result<void> take_poses(const PlanArguments& args, Wanted& wanted) {
  if (!args.config.empty()) return take_config(args, wanted);
  calib::design::DesignRequest& request = wanted.request;
  if (args.poses.empty()) {
    auto poses = run::planned_poses(config::Config{});
    if (!poses) return tl::unexpected(poses.error());
    request.poses = std::move(*poses);
    return {};
  }
  const auto listed = listed_poses(args.poses);
  if (!listed) return tl::unexpected(listed.error());
  if (auto ok = look_for_vector(listed->text, args.poses); !ok) return ok;
  if (args.calibration.empty() && args.array.array.empty()) {
    // A table that was measured tells its own sensors; a list of poses is for the cross.
    if (const auto measured = calib::poses::parse_pose_table(listed->text, args.poses)) {
      const auto array =
          array_for(args.array, calib::poses::sensors_of(*measured), args.poses, listed->places);
      if (!array) return tl::unexpected(array.error());
      request.geometry = *array;
    }
  }
  auto poses = calib::poses::parse_pose_list(listed->text, args.poses, request.geometry.sensors());
  if (!poses) return tl::unexpected(poses.error());
  request.poses = std::move(*poses);
  return {};
}

/// Sensors and poses are as many as the array has places: nominal ones where no calibration tells them.
Result<void> size_by_array(const PlanArguments& args, calib::design::DesignRequest& r) {
  const std::size_t sensors = r.geometry.sensors();
  if (!args.calibration.empty() && r.sensors.size() != sensors)
    return fail(ErrorCode::bad_input,
                fmt::format("{} is the calibration of {}, and the array has {}", args.calibration,
                            calib::poses::counted(r.sensors.size()), calib::poses::counted(sensors)),
                "leave --cal out, or name a calibration of this array");
  r.sensors.resize(sensors);
  for (Pose& pose : r.poses.poses) {
    pose.y_nT.resize(sensors, Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()));
    pose.sd_nT.resize(sensors);
    pose.T_degC.resize(sensors);
  }
  return {};
}

/// The command line takes precedence over the configuration, and that over the earlier calibration.
Result<Wanted> wanted_of(const PlanArguments& args) {
  Wanted out;
  calib::design::DesignRequest& r = out.request;
  r.scalar_sd_nT = args.scalar_sd_nT;
  r.pose_noise_nT = args.noise_nT;
  r.warming_degC = args.warming_degC;
  if (!args.calibration.empty()) {
    const auto calibration = read_calibration(args.calibration);
    if (!calibration) return tl::unexpected(calibration.error());
    r.sensors = calibration->sensors;
    r.geometry = calibration->geometry;
    r.f_nT = calibration->reference.f_nT.value_or(r.f_nT);
  }
  const auto array = array_of(args.array);
  if (!array) return tl::unexpected(array.error());
  if (*array) r.geometry = **array;  // how many sensors a list may name
  if (auto taken = take_poses(args, out); !taken) return tl::unexpected(taken.error());
  for (const std::string& name : args.with) {
    auto effect = calib::effects::library::make_effect(name);
    if (!effect) return tl::unexpected(effect.error());
    r.effects.push_back(*effect);
  }
  if (args.no_scalar) r.scalar_sd_nT = std::nullopt;
  if (args.field_nT) {
    r.f_nT = *args.field_nT;
    r.field_known = true;
  }
  if (args.field_sd_nT) r.field_sd_nT = *args.field_sd_nT;
  if (*array) r.geometry = **array;
  if (auto sized = size_by_array(args, r); !sized) return tl::unexpected(sized.error());
  if (args.inclination_deg) r.inclination_rad = to_rad(*args.inclination_deg);
  if (args.declination_deg) r.declination_rad = to_rad(*args.declination_deg);
  if (args.table_sd_deg) r.table_sd_rad = to_rad(*args.table_sd_deg);
  return out;
}

int run_plan(const Session& session, const PlanArguments& args) {
  if (const auto ready = ready_for_figures(session, args.figures); !ready)
    return print_error(session, ready.error());
  const auto wanted = wanted_of(args);
  if (!wanted) return print_error(session, wanted.error());
  const auto planned = with_progress("plan", [&] { return calib::design::evaluate_design(wanted->request); });
  if (!planned) return print_error(session, planned.error());
  std::optional<run::LimitsCost> limits;
  if (wanted->run) {
    auto cost = with_progress(
        "plan", [&] { return run::limits_cost(wanted->run->options, wanted->run->limits, wanted->request); });
    if (!cost) return print_error(session, cost.error());
    limits = *std::move(cost);
  }
  nlohmann::json out = calib::report::to_json(*planned);
  if (auto drawn = hand_out(
          args.figures, [&] { return calib::report::design_figures(wanted->request, *planned); }, out);
      !drawn)
    return print_error(session, drawn.error());
  if (session.json) {
    if (limits) out["limits"] = run::to_json(*limits);
    print_json(out);
  } else {
    print_text(session, (limits ? run::to_text(*limits) + "\n" : "") +
                            calib::report::to_text(*planned, table_width(session)));
  }
  return planned->determined ? 0 : 1;
}

}  // namespace

void add_plan(CLI::App& app, Session& session) {
  auto args = std::make_shared<PlanArguments>();
  CLI::App* const command =
      add_command(app, session, "plan", "before measuring: what a pose list can and cannot determine",
                  [args, &session] { return run_plan(session, *args); });
  command->footer(kPlanHelp);
  auto* const poses =
      command->add_option("POSES", args->poses, "pose list in CSV, or *.mgtrun; the default run when absent");
  command->add_option("--config", args->config, "take poses, limits and site from this configuration")
      ->excludes(poses);
  command->add_option("--cal", args->calibration,
                      "take the sensors from an earlier calibration of this rig (CAL.json)");
  command->add_option("--with", args->with, "effect to plan for, by name; may be repeated")
      ->allow_extra_args(false);
  command->add_option("--noise", args->noise_nT, "noise of a pose mean in nT, each axis")
      ->check(above_zero(100'000, "nT"))
      ->capture_default_str();
  command->add_option("--scalar-sd", args->scalar_sd_nT, "standard uncertainty of the scalar reference in nT")
      ->check(above_zero(100'000, "nT"))
      ->capture_default_str();
  command
      ->add_option("--warming", args->warming_degC,
                   "warming of the heads during the run in degC, where the poses have no temperature")
      ->check(in_range(-100, 100, "degC"))
      ->capture_default_str();
  add_figures_flag(command, args->figures);
  command->add_flag("--no-scalar", args->no_scalar, "there is no scalar reference");
  command
      ->add_option("--field", args->field_nT,
                   "total field in nT (50000); without a scalar reference: it is known")
      ->check(in_range(1'000, 200'000, "nT"));
  command->add_option("--field-sd", args->field_sd_nT, "its standard uncertainty in nT")
      ->check(above_zero(10'000, "nT"));
  add_array_flags(command, args->array);
  command
      ->add_option("--inclination", args->inclination_deg,
                   "inclination of the field at zero table angles, deg (60)")
      ->check(in_range(-90, 90, "deg"));
  command->add_option("--declination", args->declination_deg, "its declination, from X towards Y, deg (0)")
      ->check(in_range(-360, 360, "deg"));
  command->add_option("--table-sd", args->table_sd_deg, "standard deviation of a table angle in deg (0.1)")
      ->check(above_zero(10, "deg"));
}

}  // namespace mgtd::daemon::cli
