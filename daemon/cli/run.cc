// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "calib/poses/pose_list.h"
#include "daemon/cli/ask.h"
#include "daemon/cli/course_text.h"
#include "daemon/cli/in_range.h"
#include "daemon/cli/input_lines.h"
#include "daemon/cli/interrupt.h"
#include "daemon/cli/progress.h"
#include "daemon/cli/prompt.h"
#include "daemon/cli/run_notices.h"
#include "daemon/plan/plan_from_list.h"
#include "daemon/plan/run_plan_json.h"
#include "daemon/run/limits_cost.h"
#include "daemon/run/planned_poses.h"
#include "proto/run_request.h"
#include "proto/status_codec.h"

namespace mgtd::daemon::cli {
namespace {

struct RunArguments {
  RunRequest request;
  std::string poses_file;
  bool detach{false}, until_explained{false};
  double minutes{30};
  std::vector<double> scales_deg;
};

int print_end(const Session& session, const RunStatus& run) {
  if (session.json) print_json(nlohmann::json(to_json(run)));
  if (run.message.find(run.judged) == std::string::npos) fmt::print(stderr, "{}\n", run.judged);
  fmt::print(stderr, "{}: {}\n", name(run.state), run.message);
  if (run.state == RunState::paused && run.message.find("mgt run resume") == std::string::npos)
    fmt::print(stderr, "mgt run resume goes on with it, mgt run abort ends it\n");
  fmt::print(stderr, "{}", failed_lines(run));
  if (run.state != RunState::done) return 1;
  if (!session.json)
    fmt::print("proposed: {}\naccept it with: mgt calibrations accept {}\n", run.proposed, run.proposed);
  return 0;
}

/// Asks until the operator enters something that the daemon accepts, or interrupts, or the run is no longer
/// where it asks this. False at the end of the input.
bool answer(const Session& session, serve::ControlClient& client, InputLines& keyboard,
            const OperatorPrompt& prompt) {
  for (;;) {
    fmt::print(stderr, "{}", question(prompt));
    const auto line = session.json ? std::nullopt : keyboard.next();
    if (interrupted()) return true;
    if (!line) {
      fmt::print(stderr, "\nno more input here; answer from any terminal with: mgt run {}\n",
                 prompt.what == OperatorPrompt::What::note ? "resume" : "enter AZIMUTH PITCH ROLL");
      return false;
    }
    const auto said = parse_answer(*line, prompt);
    const auto done = said ? client.request(said->command, said->args)
                           : Result<nlohmann::json>(tl::unexpected(said.error()));
    if (done) return true;
    fmt::print(stderr, "{}\n", done.error().text());
    if (done.error().code == ErrorCode::state) return true;
  }
}

/// Shows the run until it ends or waits for the operator. Ctrl-C leaves it running.
int follow(const Session& session) {
  const bool terminal = isatty(STDERR_FILENO) != 0;
  catch_interrupts({SIGINT});
  auto client = serve::ControlClient::connect(session.control_socket);
  if (!client) return print_error(session, client.error());
  std::string judged;
  InputLines keyboard(STDIN_FILENO);
  RunNotices notices;
  int last_tenth = -1;
  while (!interrupted()) {
    const auto reply = client->request(ControlCommand::run_status);
    if (!reply) return print_error(session, reply.error());
    const auto run = run_status_from_json(*reply);
    if (!run) return print_error(session, run.error());
    if (run->state == RunState::idle)
      return print_error(session, {ErrorCode::state, "no run is going on", "mgt run start begins one"});
    if (run->judged != judged && run->state != RunState::done) {
      judged = run->judged;
      fmt::print(stderr, "{}{}\n", terminal ? "\r\033[K" : "", judged);
    }
    if (const std::string notice = notices.of(*run); !notice.empty())
      fmt::print(stderr, "{}{}", terminal ? "\r\033[K" : "", notice);
    const std::string line = progress_line(*run, terminal_width(STDERR_FILENO) - 1);
    const int tenth = run->poses > 0 ? 10 * run->pose / run->poses : 0;
    if (terminal) {
      fmt::print(stderr, "\r\033[K{}", line);
    } else if (tenth != last_tenth) {
      fmt::print(stderr, "{}\n", line);
      last_tenth = tenth;
    }
    if (run->prompt) {
      if (terminal) fmt::print(stderr, "\n");
      if (!answer(session, *client, keyboard, *run->prompt)) return print_end(session, *run);
      continue;
    }
    if (!is_active(run->state) || (run->state == RunState::paused && !run->goes_on)) {
      if (terminal) fmt::print(stderr, "\n");
      return print_end(session, *run);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
  fmt::print(stderr, "\nthe run goes on; mgt run follow shows it again, mgt run abort ends it\n");
  return 0;
}

/// The request with the poses of the file, if one is named.
Result<nlohmann::json> request_of(const RunArguments& args) {
  RunRequest request = args.request;
  if (args.until_explained) request.until_explained_min = args.minutes;
  if (!args.poses_file.empty()) {
    const auto text = read_file(args.poses_file);
    if (!text) return tl::unexpected(text.error());
    const auto list = calib::poses::read_pose_list(*text, args.poses_file);
    if (!list) return tl::unexpected(list.error());
    request.list = std::filesystem::path(args.poses_file).filename();
    request.poses = plan::requested_poses(*list);
  }
  nlohmann::json out = to_json(request);
  if (out.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace).size() + 100 > kControlLineLimit)
    return fail(ErrorCode::bad_input,
                fmt::format("{}: {} poses are too many for one run", args.poses_file, request.poses.size()),
                "split the list");
  return out;
}

int start(const Session& session, const RunArguments& args) {
  const auto request = request_of(args);
  if (!request) return print_error(session, request.error());
  const auto reply = ask(session, ControlCommand::run_start, *request);
  if (!reply) return print_error(session, reply.error());
  if (!args.detach) return follow(session);
  if (session.json) print_json(*reply);
  return 0;
}

/// What the limits of the daemon's table cost this run. Nothing where there are none, and for a list of
/// poses, which is taken as intended. An error if the plan cannot calibrate even without limits.
Result<std::optional<run::LimitsCost>> cost_of_limits(const nlohmann::json& reply) {
  for (const char* key : {"options", "limits_deg", "config"})
    if (!reply.contains(key))
      return fail(ErrorCode::protocol, fmt::format("the daemon's answer has no '{}'", key),
                  "use mgt and mgtd of the same version");
  const auto options = plan::plan_options_from_json(reply.at("options"));
  if (!options) return tl::unexpected(options.error());
  if (!options->list.empty()) return std::optional<run::LimitsCost>();
  const auto limits = plan::table_limits_from_json(reply.at("limits_deg"));
  if (!limits) return tl::unexpected(limits.error());
  const auto config =
      config::parse_config(reply.at("config").get<std::string>(), "the daemon's configuration");
  if (!config)
    return fail(ErrorCode::protocol, config.error().lines.front(), "use mgt and mgtd of the same version");
  calib::design::DesignRequest request;
  run::assume(*config, request);
  return run::limits_cost(*options, *limits, std::move(request));
}

int dry_run(const Session& session, const RunArguments& args) {
  const auto request = request_of(args);
  if (!request) return print_error(session, request.error());
  auto reply = ask(session, ControlCommand::run_dry_run, *request);
  if (!reply) return print_error(session, reply.error());
  const auto limits = cost_of_limits(*reply);
  if (!limits)
    fmt::print(stderr, "what the limits of the table cost cannot be computed: {}\n", limits.error().text());
  if (session.json) {
    reply->erase("config");
    if (limits && *limits) (*reply)["limits"] = run::to_json(**limits);
    print_json(*reply);
    return 0;
  }
  print_text(session, fmt::format("{}\n{}nothing was moved\n", reply->at("text").get<std::string>(),
                                  limits && *limits ? run::to_text(**limits) : ""));
  return 0;
}

int simple(const Session& session, ControlCommand command, bool then_follow) {
  const auto reply = ask(session, command);
  if (!reply) return print_error(session, reply.error());
  if (then_follow) return follow(session);
  const auto run = run_status_from_json(*reply);
  if (!run) return print_error(session, run.error());
  if (session.json) {
    print_json(*reply);
  } else {
    print_text(session, fmt::format("{}\n{}\n{}", progress_line(*run, 100), run->message,
                                    command == ControlCommand::run_status ? failed_lines(*run) : ""));
  }
  return 0;
}

int course(const Session& session) {
  const auto reply = ask(session, ControlCommand::run_course);
  if (!reply) return print_error(session, reply.error());
  if (session.json)
    print_json(*reply);
  else
    print_text(session, course_text(*reply));
  return 0;
}

int events(const Session& session) {
  const auto reply = ask(session, ControlCommand::run_events);
  if (!reply) return print_error(session, reply.error());
  if (session.json)
    print_json(*reply);
  else
    print_text(session, events_text(*reply));
  return 0;
}

int enter(const Session& session, const RunArguments& args) {
  const auto reply = ask(session, ControlCommand::run_enter,
                         {{"azimuth_deg", args.scales_deg[0]},
                          {"pitch_deg", args.scales_deg[1]},
                          {"roll_deg", args.scales_deg[2]}});
  if (!reply) return print_error(session, reply.error());
  if (session.json)
    print_json(*reply);
  else
    fmt::print("{}\n", reply->value("message", ""));
  return 0;
}

void add_plan_options(CLI::App* command, RunArguments& args) {
  RunRequest& r = args.request;
  command->add_option("--poses", args.poses_file,
                      "measure the poses of this list (CSV), as mgt next -o writes it, instead of sets");
  command->add_option("--step", r.step_deg, "degrees between standard poses: 10 or 20");
  command->add_option("--random", r.random, "random poses");
  command->add_option("--revisits", r.revisits, "how many of them return to an earlier attitude");
  command->add_option("--dwell-short", r.dwell_short_s, "seconds");
  command->add_option("--dwell-long", r.dwell_long_s, "seconds");
  command->add_option("--retries", r.retries, "how often a bad pose is measured again before the run pauses");
  command->add_option("--seed", r.seed, "of the random set")->check(seed_number());
}

}  // namespace

void add_run(CLI::App& app, Session& session) {
  CLI::App* const group = app.add_subcommand("run",
                                             "a calibration run: start, dry-run, magnet-test, follow, "
                                             "course, events, enter, redo, pause, resume, finish, abort");
  group->require_subcommand(1);
  auto args = std::make_shared<RunArguments>();
  CLI::App* const begin = add_command(
      *group, session, "start", "preflight, home, measure every pose, solve, propose; shows the progress",
      [args, &session] { return start(session, *args); });
  add_plan_options(begin, *args);
  begin->add_option("--until-tensor-sd", args->request.until_tensor_sd_nT_per_m,
                    "end the run once the calibration leaves so little in the tensor, nT/m, worst component");
  CLI::Option* const until = begin->add_flag(
      "--until-explained", args->until_explained,
      "judge the run when its plan is measured, and measure what would make the verdict clear, until it is");
  begin->add_option("--minutes", args->minutes, "with --until-explained: that it may take, beside the plan")
      ->check(CLI::Range(1.0, 10'000.0))
      ->capture_default_str()
      ->needs(until);
  begin->add_flag("--detach", args->detach, "do not wait for the end");
  CLI::App* const dry = add_command(*group, session, "dry-run",
                                    "what a run would do, and how long it would take; moves nothing",
                                    [args, &session] { return dry_run(session, *args); });
  add_plan_options(dry, *args);
  add_command(*group, session, "follow", "show the run that is going on",
              [&session] { return follow(session); });
  add_command(*group, session, "status", "the run in one object",
              [&session] { return simple(session, ControlCommand::run_status, false); });
  add_command(*group, session, "course",
              "what the run has gained so far: directions of the field, accuracy, disturbances",
              [&session] { return course(session); });
  add_command(*group, session, "events",
              "what the run wrote down: bad poses, pauses, lost devices, decisions",
              [&session] { return events(session); });
  add_command(*group, session, "pause", "stop the table; the present pose will be measured again",
              [&session] { return simple(session, ControlCommand::run_pause, false); });
  add_command(*group, session, "resume",
              "go on after a pause, or with a run that failed or that a dead daemon left",
              [args, &session] { return simple(session, ControlCommand::run_resume, !args->detach); })
      ->add_flag("--detach", args->detach, "do not wait for the end");
  CLI::App* const entered =
      add_command(*group, session, "enter", "tell the run what the scales say, when it asks",
                  [args, &session] { return enter(session, *args); });
  entered->add_option("ANGLES", args->scales_deg, "azimuth, pitch and roll in degrees")
      ->required()
      ->expected(3);
  add_magnet_test(*group, session);
  add_command(*group, session, "redo", "ask for the last entry again, and measure again what depends on it",
              [&session] { return simple(session, ControlCommand::run_redo, false); });
  add_command(*group, session, "finish", "stop measuring and fit the poses so far",
              [&session] { return simple(session, ControlCommand::run_finish, true); });
  add_command(*group, session, "abort", "end the run or the magnet test; the active calibration stays",
              [&session] { return simple(session, ControlCommand::run_abort, false); });
}

}  // namespace mgtd::daemon::cli
