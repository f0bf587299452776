// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/cli/command.h"
#include "daemon/cli/help_format.h"
#include "proto/nearest_word.h"
#include "proto/standard_output.h"
#include "proto/version.h"

namespace {

/// The error when a command was expected and the word is none; empty if the mistake was another one.
std::optional<mgtd::Error> unknown_command(const CLI::App& app) {
  const CLI::App* group = &app;
  while (!group->get_subcommands().empty()) group = group->get_subcommands().front();
  const std::vector<std::string> left = app.remaining(true);
  std::vector<std::string> commands;
  for (const CLI::App* command : group->get_subcommands([](const CLI::App*) { return true; }))
    commands.push_back(command->get_name());
  if (commands.empty() || left.empty() || left.front().starts_with('-')) return std::nullopt;
  const auto meant = mgtd::nearest_word(left.front(), commands);
  return mgtd::Error{mgtd::ErrorCode::usage,
                     fmt::format("unknown command '{}'{}", left.front(),
                                 meant ? fmt::format(", did you mean '{}'?", *meant) : ""),
                     fmt::format("there are: {}", fmt::join(commands, ", "))};
}

/// The option that a word beginning with '-' was meant to be; of the command and of all it belongs to.
std::optional<std::string> meant_option(const CLI::App* command, const std::string& wrong) {
  std::vector<std::string> there;
  for (const CLI::App* at = command; at != nullptr; at = at->get_parent())
    for (const CLI::Option* option : at->get_options())
      for (const std::string& name : option->get_lnames()) there.push_back("--" + name);
  return mgtd::nearest_word(wrong.substr(0, wrong.find('=')), there);
}

/// "unknown option '--fild', did you mean '--field'?"; empty if no option is unknown.
std::optional<std::string> unknown_option(const CLI::App& app, const CLI::App* command) {
  for (const std::string& word : app.remaining(true)) {
    if (!word.starts_with("--")) continue;
    const auto meant = meant_option(command, word);
    return fmt::format("unknown option '{}'{}", word,
                       meant ? fmt::format(", did you mean '{}'?", *meant) : "");
  }
  return std::nullopt;
}

/// The error when the arguments of a command are wrong; for a group without a command it lists the commands.
mgtd::Error wrong_words(const CLI::App& app, const CLI::Error& error) {
  const CLI::App* at = &app;
  while (!at->get_subcommands().empty()) at = at->get_subcommands().front();
  std::string path;
  for (const CLI::App* x = at; x != &app; x = x->get_parent()) path = " " + x->get_name() + path;
  std::vector<std::string> commands;
  for (const CLI::App* x : at->get_subcommands([](const CLI::App*) { return true; }))
    commands.push_back(x->get_name());
  const bool lacks = !commands.empty() && error.get_name() == "RequiredError";
  const auto option = unknown_option(app, at);
  return {mgtd::ErrorCode::usage,
          lacks    ? "which command?"
          : option ? *option
                   : error.what(),
          fmt::format("{}mgt{} --help tells more",
                      lacks ? fmt::format("one of {}; ", fmt::join(commands, ", ")) : "", path)};
}

constexpr const char* kDescription =
    "mgt: the operator's tool for a magnetic gradient tensor rig\n\n"
    "Live (talks to mgtd):     status, watch, run, calibrations, history, control,\n"
    "                          console\n"
    "Offline (files):          plan, fit, apply, check, diff, import, export, replay, check-config, ports\n"
    "What is missing:          compare, explain, why, discover, effects, add, drop, mask, unmask, undo, "
    "model, "
    "define,\n"
    "                          next, improve, report, serve (in a browser)\n\n"
    "A first calibration:      mgt run dry-run ; mgt run start ; mgt calibrations accept ID\n"
    "The same from a file:     mgt fit RUN.mgtrun -o CAL.json ; mgt apply CAL.json RUN.mgtrun\n\n"
    "Exit codes: 0 done, 1 answered \"no\", 2 usage or unreadable input, 3 daemon or instrument not reached.";

int run(int argc, char** argv) {
  using namespace mgtd::daemon::cli;
  CLI::App app{kDescription, "mgt"};
  app.formatter(std::make_shared<HelpFormat>());
  app.set_version_flag("--version", mgtd::version());
  app.require_subcommand(1);
  app.fallthrough();
  mgtd::daemon::cli::Session session;
  session.control_socket = "/run/mgtd/control.sock";
  app.add_option("--socket", session.control_socket, "control socket of the daemon")
      ->envname("MGTD_CONTROL")
      ->capture_default_str();
  app.add_flag("--json", session.json,
               "one JSON object on stdout, messages on stderr; also after the command");
  app.add_option("--color", session.color,
                 "judgements in colour: auto (on a terminal, unless NO_COLOR is set), always, never")
      ->check(CLI::IsMember({"auto", "always", "never"}))
      ->capture_default_str();
  mgtd::daemon::cli::add_status(app, session);
  mgtd::daemon::cli::add_watch(app, session);
  mgtd::daemon::cli::add_run(app, session);
  mgtd::daemon::cli::add_calibrations(app, session);
  mgtd::daemon::cli::add_control(app, session);
  mgtd::daemon::cli::add_console(app, session);
  mgtd::daemon::cli::add_fit(app, session);
  mgtd::daemon::cli::add_apply(app, session);
  mgtd::daemon::cli::add_plan(app, session);
  mgtd::daemon::cli::add_check(app, session);
  mgtd::daemon::cli::add_compare(app, session);
  mgtd::daemon::cli::add_diff(app, session);
  mgtd::daemon::cli::add_history(app, session);
  mgtd::daemon::cli::add_explain(app, session);
  mgtd::daemon::cli::add_why(app, session);
  mgtd::daemon::cli::add_discover(app, session);
  mgtd::daemon::cli::add_effects(app, session);
  mgtd::daemon::cli::add_improve(app, session);
  mgtd::daemon::cli::add_add(app, session);
  mgtd::daemon::cli::add_drop(app, session);
  mgtd::daemon::cli::add_mask(app, session);
  mgtd::daemon::cli::add_unmask(app, session);
  mgtd::daemon::cli::add_undo(app, session);
  mgtd::daemon::cli::add_model(app, session);
  mgtd::daemon::cli::add_define(app, session);
  mgtd::daemon::cli::add_next(app, session);
  mgtd::daemon::cli::add_replay(app, session);
  mgtd::daemon::cli::add_report(app, session);
  mgtd::daemon::cli::add_serve(app, session);
  mgtd::daemon::cli::add_import(app, session);
  mgtd::daemon::cli::add_export(app, session);
  mgtd::daemon::cli::add_check_config(app, session);
  mgtd::daemon::cli::add_ports(app, session);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // --help, --version
      std::ostringstream out;
      app.exit(error, out, out);
      fmt::print("{}", out.str());
      return 0;
    }
    const std::span words(argv, static_cast<std::size_t>(argc));
    session.json =
        session.json || std::find(words.begin(), words.end(), std::string_view("--json")) != words.end();
    const auto unknown = unknown_command(app);
    return mgtd::daemon::cli::print_error(session, unknown ? *unknown : wrong_words(app, error));
  } catch (const std::bad_alloc&) {
    return mgtd::daemon::cli::print_error(
        session, {mgtd::ErrorCode::io, "there is not enough memory for this",
                  "end other programs, raise the limit of this one (ulimit -v), or give it fewer poses"});
  }
  return session.exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  return mgtd::with_standard_output("mgt", mgtd::exit_code(mgtd::ErrorCode::io),
                                    [&] { return run(argc, argv); });
}
