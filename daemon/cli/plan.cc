// SPDX-License-Identifier: Apache-2.0
#include "calib/plan.h"

#include <fmt/format.h>

#include "calib/plan_report.h"
#include "calib/pose_table.h"
#include "daemon/cli/calibration_file.h"
#include "daemon/cli/command.h"
#include "daemon/cli/in_range.h"
#include "daemon/planned_poses.h"

namespace mgtd::cli {
namespace {

constexpr const char* kHelp =
    R"(Prints the standard error that every parameter and the tensor would have, what stays weakly known and which
poses would help most. The poses are those of POSES.csv (columns pose, azimuth_deg, pitch_deg, roll_deg and
whatever an effect needs; readings are not looked at), or those of the run that a configuration describes, or
of the default run. With an effect: how well its coefficients would be known, and told from the rest.

Then, for every effect of the library that is not planned for: the smallest size that the run would show, and
the pairs of effects that it could not tell apart, with the further measurement that would.

  mgt plan                                    the default run of 157 poses
  mgt plan --config rig.toml --noise 0.3      the run this rig would do, 0.3 nT a pose mean
  mgt plan poses.csv --with site.gradient     a list of your own

Exit code 0: every parameter would be determined. 1: not; the poses to add are printed.)";

struct Arguments {
  std::string poses, config, calibration;
  std::vector<std::string> with;
  double noise_nT{1}, warming_degC{2}, scalar_sd_nT{kDefaultScalarSd_nT};
  bool no_scalar{false};
  std::optional<double> field_nT, field_sd_nT, baseline_m, inclination_deg, declination_deg, table_sd_deg;
};

Result<void> take_config(const Arguments& args, calib::PlanRequest& request) {
  const auto config = daemon::load_config(args.config);
  if (!config) {
    std::string all;
    for (const std::string& line : config.error().lines) all += (all.empty() ? "" : "\n") + line;
    return fail(ErrorCode::bad_input, all, "mgt check-config FILE lists every mistake");
  }
  auto poses = daemon::planned_poses(*config);
  if (!poses) return tl::unexpected(poses.error());
  request.poses = std::move(*poses);
  request.candidates = daemon::reachable(*config, std::move(request.candidates));
  request.geometry.baseline_m = config->baseline_m;
  request.table_sd_rad = to_rad(config->table_sd_deg);
  request.f_nT = config->field_nT.value_or(request.f_nT);
  if (!config->scalar) request.scalar_sd_nT = std::nullopt;
  request.field_known = config->field_nT.has_value();
  request.field_sd_nT = config->field_sd_nT;
  if (config->inclination_deg) request.inclination_rad = to_rad(*config->inclination_deg);
  if (config->declination_deg) request.declination_rad = to_rad(*config->declination_deg);
  return {};
}

Result<void> take_poses(const Arguments& args, calib::PlanRequest& request) {
  if (!args.config.empty()) return take_config(args, request);
  if (args.poses.empty()) {
    auto poses = daemon::planned_poses(daemon::Config{});
    if (!poses) return tl::unexpected(poses.error());
    request.poses = std::move(*poses);
    return {};
  }
  const auto text = read_file(args.poses);
  if (!text) return tl::unexpected(text.error());
  auto poses = calib::parse_pose_list(*text, args.poses);
  if (!poses) return tl::unexpected(poses.error());
  request.poses = std::move(*poses);
  return {};
}

/// What the command line says goes before the configuration, and that before the earlier calibration.
Result<calib::PlanRequest> request_of(const Arguments& args) {
  calib::PlanRequest r;
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
  if (auto taken = take_poses(args, r); !taken) return tl::unexpected(taken.error());
  for (const std::string& name : args.with) {
    auto effect = calib::make_effect(name);
    if (!effect) return tl::unexpected(effect.error());
    r.effects.push_back(*effect);
  }
  if (args.no_scalar) r.scalar_sd_nT = std::nullopt;
  if (args.field_nT) {
    r.f_nT = *args.field_nT;
    r.field_known = true;
  }
  if (args.field_sd_nT) r.field_sd_nT = *args.field_sd_nT;
  if (args.baseline_m) r.geometry.baseline_m = *args.baseline_m;
  if (args.inclination_deg) r.inclination_rad = to_rad(*args.inclination_deg);
  if (args.declination_deg) r.declination_rad = to_rad(*args.declination_deg);
  if (args.table_sd_deg) r.table_sd_rad = to_rad(*args.table_sd_deg);
  return r;
}

int run_plan(const Session& session, const Arguments& args) {
  const auto request = request_of(args);
  if (!request) return report(session, request.error());
  const auto planned = calib::plan(*request);
  if (!planned) return report(session, planned.error());
  if (session.json) {
    print_json(calib::to_json(*planned));
  } else {
    fmt::print("{}", calib::to_text(*planned));
  }
  return planned->determined ? 0 : 1;
}

}  // namespace

void add_plan(CLI::App& app, Session& session) {
  auto args = std::make_shared<Arguments>();
  CLI::App* const command =
      add_command(app, session, "plan", "before measuring: what a pose list can and cannot determine",
                  [args, &session] { return run_plan(session, *args); });
  command->footer(kHelp);
  auto* const poses =
      command->add_option("POSES", args->poses, "pose list in CSV; the default run when absent");
  command->add_option("--config", args->config, "take poses, limits and site from this configuration")
      ->excludes(poses);
  command->add_option("--cal", args->calibration,
                      "an earlier calibration of this rig (CAL.json): its sensors");
  command->add_option("--with", args->with, "effect to plan for, by name; may be given again")
      ->allow_extra_args(false);
  command->add_option("--noise", args->noise_nT, "noise of a pose mean in nT, each axis")
      ->check(above_zero(100'000, "nT"))
      ->capture_default_str();
  command->add_option("--scalar-sd", args->scalar_sd_nT, "standard uncertainty of the scalar reference in nT")
      ->check(above_zero(100'000, "nT"))
      ->capture_default_str();
  command
      ->add_option("--warming", args->warming_degC,
                   "warming of the heads during the run in degC, where the poses tell no temperature")
      ->check(in_range(-100, 100, "degC"))
      ->capture_default_str();
  command->add_flag("--no-scalar", args->no_scalar, "there is no scalar reference");
  command
      ->add_option("--field", args->field_nT,
                   "total field in nT (50000); without a scalar reference: it is known")
      ->check(in_range(1'000, 200'000, "nT"));
  command->add_option("--field-sd", args->field_sd_nT, "its standard uncertainty in nT")
      ->check(above_zero(10'000, "nT"));
  command->add_option("--baseline", args->baseline_m, "distance of opposite sensors in m (0.4)")
      ->check(in_range(0.05, 10, "m"));
  command->add_option("--inclination", args->inclination_deg, "of the field at zero table angles, deg (60)")
      ->check(in_range(-90, 90, "deg"));
  command->add_option("--declination", args->declination_deg, "the same, from X towards Y, deg (0)")
      ->check(in_range(-360, 360, "deg"));
  command->add_option("--table-sd", args->table_sd_deg, "standard deviation of a table angle in deg (0.1)")
      ->check(above_zero(10, "deg"));
}

}  // namespace mgtd::cli
