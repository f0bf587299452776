// SPDX-License-Identifier: Apache-2.0
// Poses that every command leaves out, with the reason: mask, unmask.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "calib/fit/joint/joint_report.h"
#include "calib/fit/joint/pose_residuals.h"
#include "daemon/cli/command.h"
#include "daemon/cli/kept_run.h"
#include "daemon/cli/work_progress.h"
#include "daemon/store/pose_numbers.h"
#include "proto/pose_numbers_text.h"

namespace mgtd::daemon::cli {
namespace {

using nlohmann::json;

constexpr const char* kMaskHelp =
    "Every command on the run file leaves masked poses out and says so; they stay in the file. The reason "
    "is\n"
    "kept with them (mgt model). mgt undo takes the last mask back, mgt unmask takes poses in again.\n"
    "Poses can be masked even while the fit of the others is still refused.\n"
    "--without POSES of fit, compare, explain, why, next and improve tries it without keeping it.\n\n"
    "  mgt mask run.mgtrun 3 7-9 --why 'a car stood beside the rig'\n"
    "  mgt unmask run.mgtrun 3 7-9\n\n"
    "Exit code 0.";

struct MaskArguments {
  std::string run, why, who;
  std::vector<std::string> poses;
  std::shared_ptr<FitFlags> flags;
};

/// The residual of the model on these poses.
Result<double> residual_nT(const PoseTable& table, const calib::fit::FitOptions& options) {
  const auto joint = calib::fit::joint::profiled_options(table, options);
  if (!joint) return tl::unexpected(joint.error());
  const auto fit = calib::fit::joint::fit_joint_at_size(table, *joint);
  if (!fit) return tl::unexpected(fit.error());
  return calib::fit::joint::pose_residuals(fit->problem, fit->state).residual_nT();
}

std::set<int> masked_in(const store::PoseSource& source) {
  std::set<int> out;
  for (const store::MaskedPose& m : source.masked) out.insert(m.number);
  return out;
}

/// Keeps a step that leads to `table`, and prints it.
int keep_mask(const Session& session, const MaskArguments& args, const std::string& action,
              const std::set<int>& numbers, const PoseTable& table, KeptRun& run) {
  const auto before = with_progress(action, run.options, [&](const calib::fit::FitOptions& told) {
    return residual_nT(run.source.table, told);
  });
  const auto after = with_progress(
      action, run.options, [&](const calib::fit::FitOptions& told) { return residual_nT(table, told); });
  if (!after && after.error().code != ErrorCode::refused) return print_error(session, after.error());
  const std::string spec = pose_numbers_text(numbers);
  json result{{"because", args.why}};
  result["rms_before_nT"] = before ? json(*before) : json();
  result["rms_after_nT"] = after ? json(*after) : json();
  if (auto ok = keep_step(run, action, spec, result); !ok) return print_error(session, ok.error());
  std::set<int> masked = masked_in(run.source);
  for (const int number : numbers) {
    if (action == "mask") {
      masked.insert(number);
    } else {
      masked.erase(number);
    }
  }
  if (session.json) {
    json out = result;
    out["schema"] = "mgt.mask/1";
    out["action"] = action;
    out["poses"] = numbers;
    out["masked"] = masked;
    if (!after) out["refused"] = after.error().text();
    print_json(out);
    return 0;
  }
  std::string text = fmt::format("{}: {}{}\n", action == "mask" ? "masked" : "taken in again", spec,
                                 args.why.empty() ? "" : " (" + args.why + ")");
  if (before || after) text += fmt::format("residual {}\n", residual_change(result, "->"));
  text += fmt::format("masked now: {}\n", masked.empty() ? "none" : pose_numbers_text(masked));
  if (!after) text += fmt::format("no fit of what is left yet: {}\n", after.error().text());
  print_text(session, text);
  return 0;
}

int run_mask(const Session& session, const MaskArguments& args) {
  const auto numbers = store::parse_pose_numbers(fmt::format("{}", fmt::join(args.poses, ",")));
  if (!numbers) return print_error(session, numbers.error());
  auto run = open_kept_run(args.run, *args.flags);
  if (!run) return print_error(session, run.error());
  run->who = args.who;
  const auto table = store::without_poses(run->source.table, *numbers);
  if (!table) return print_error(session, table.error());
  return keep_mask(session, args, "mask", *numbers, *table, *run);
}

int run_unmask(const Session& session, const MaskArguments& args) {
  const auto numbers = store::parse_pose_numbers(fmt::format("{}", fmt::join(args.poses, ",")));
  if (!numbers) return print_error(session, numbers.error());
  auto run = open_kept_run(args.run, *args.flags);
  if (!run) return print_error(session, run.error());
  run->who = args.who;
  const std::set<int> masked = masked_in(run->source);
  if (!std::includes(masked.begin(), masked.end(), numbers->begin(), numbers->end())) {
    return print_error(
        session, {ErrorCode::usage, fmt::format("not all of {} are masked", pose_numbers_text(*numbers)),
                  masked.empty() ? "no pose of this run is" : "masked are " + pose_numbers_text(masked)});
  }
  auto all = store::read_run(args.run, store::Masked::kept);
  if (!all) return print_error(session, all.error());
  std::set<int> still;
  std::set_difference(masked.begin(), masked.end(), numbers->begin(), numbers->end(),
                      std::inserter(still, still.end()));
  const auto table = store::without_poses(std::move(all->table), still);
  if (!table) return print_error(session, table.error());
  return keep_mask(session, args, "unmask", *numbers, *table, *run);
}

CLI::App* add_mask_command(CLI::App& app, Session& session, const std::string& name,
                           const std::string& summary, int (*body)(const Session&, const MaskArguments&)) {
  auto args = std::make_shared<MaskArguments>();
  CLI::App* const command =
      add_command(app, session, name, summary, [args, &session, body] { return body(session, *args); });
  command->footer(kMaskHelp);
  command->add_option("RUN", args->run, "*.mgtrun")->required();
  command->add_option("POSE", args->poses, "numbers of poses: 3 7-9")->required();
  CLI::Option* const why = command->add_option("--why", args->why, "the reason; it is kept with the run");
  why->check([](const std::string& text) {
    return text.find_first_not_of(' ') == std::string::npos ? "say why in a few words" : std::string{};
  });
  if (name == "mask") why->required();
  add_who_option(command, args->who);
  args->flags = add_current_model_flags(command);
  return command;
}

}  // namespace

void add_mask(CLI::App& app, Session& session) {
  add_mask_command(app, session, "mask", "leave poses out of every computation, and keep the reason",
                   run_mask);
}

void add_unmask(CLI::App& app, Session& session) {
  add_mask_command(app, session, "unmask", "take masked poses in again", run_unmask);
}

}  // namespace mgtd::daemon::cli
