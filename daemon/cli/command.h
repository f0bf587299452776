// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <CLI/CLI.hpp>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "daemon/cli/terminal_text.h"
#include "daemon/store/durable_file.h"
#include "proto/error.h"

/// Every command of `mgt` shares the --json switch, the control socket, and the way results and errors are
/// printed. Results go to stdout, everything else to stderr; with --json stdout carries exactly one JSON
/// object.
namespace mgtd::daemon::cli {

struct Session {
  bool json{false};
  std::string control_socket;
  std::string color{"auto"};  ///< of text on stdout: auto, always, never
  int exit_code{0};
};

/// Prints the error with its remedy on stderr (with --json also {"error":{...}} on stdout, with the keys of
/// `beside`); returns the exit code of its kind.
int print_error(const Session& session, const Error& error, nlohmann::json beside = nlohmann::json::object());

/// Text on stdout, in the width and the colours that fit where it goes.
void print_text(const Session& session, const std::string& text);
/// How text on stdout is to look now.
[[nodiscard]] TextLook stdout_look(const Session& session);
/// Columns that a table on stdout may have: those of the terminal, elsewhere any.
[[nodiscard]] std::size_t table_width(const Session& session);

/// One JSON object on stdout.
void print_json(const nlohmann::json& object);

using store::read_file;

/// Adds a subcommand whose body runs after parsing; its return value is the exit code.
CLI::App* add_command(CLI::App& app, Session& session, const std::string& name, const std::string& summary,
                      std::function<int()> body);

void add_add(CLI::App& app, Session& session);
void add_apply(CLI::App& app, Session& session);
void add_calibrations(CLI::App& app, Session& session);
void add_check(CLI::App& app, Session& session);
void add_check_config(CLI::App& app, Session& session);
void add_compare(CLI::App& app, Session& session);
void add_console(CLI::App& app, Session& session);
void add_control(CLI::App& app, Session& session);
void add_define(CLI::App& app, Session& session);
void add_diff(CLI::App& app, Session& session);
void add_drop(CLI::App& app, Session& session);
void add_effects(CLI::App& app, Session& session);
void add_explain(CLI::App& app, Session& session);
void add_export(CLI::App& app, Session& session);
void add_fit(CLI::App& app, Session& session);
void add_history(CLI::App& app, Session& session);
void add_import(CLI::App& app, Session& session);
void add_improve(CLI::App& app, Session& session);
void add_magnet_test(CLI::App& run, Session& session);
void add_mask(CLI::App& app, Session& session);
void add_model(CLI::App& app, Session& session);
void add_next(CLI::App& app, Session& session);
void add_plan(CLI::App& app, Session& session);
void add_ports(CLI::App& app, Session& session);
void add_replay(CLI::App& app, Session& session);
void add_report(CLI::App& app, Session& session);
void add_run(CLI::App& app, Session& session);
void add_serve(CLI::App& app, Session& session);
void add_status(CLI::App& app, Session& session);
void add_undo(CLI::App& app, Session& session);
void add_unmask(CLI::App& app, Session& session);
void add_watch(CLI::App& app, Session& session);
void add_why(CLI::App& app, Session& session);
void add_discover(CLI::App& app, Session& session);

}  // namespace mgtd::daemon::cli
