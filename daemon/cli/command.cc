// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/command.h"

#include <fmt/format.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <cstdlib>
#include <utility>

#include "calib/report/seen_width.h"
#include "daemon/cli/progress.h"

namespace mgtd::daemon::cli {

TextLook stdout_look(const Session& session) {
  const auto variable = [](const char* name) {
    const char* const value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): nobody sets it
    return std::string(value != nullptr ? value : "");
  };
  return look_of(
      {isatty(STDOUT_FILENO) != 0, terminal_width(STDOUT_FILENO), variable("NO_COLOR"), variable("TERM")},
      session.color);
}

std::size_t table_width(const Session& session) {
  return stdout_look(session).width.value_or(calib::report::kAnyWidth);
}

void print_text(const Session& session, const std::string& text) {
  fmt::print("{}", shown(text, stdout_look(session)));
}

void print_json(const nlohmann::json& object) {
  fmt::print("{}\n", object.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

int print_error(const Session& session, const Error& error, nlohmann::json beside) {
  fmt::print(stderr, "mgt: {}\n", error.message);
  if (!error.remedy.empty()) fmt::print(stderr, "     {}\n", error.remedy);
  if (session.json) {
    beside["error"] = {{"code", name(error.code)}, {"message", error.message}, {"remedy", error.remedy}};
    print_json(beside);
  }
  return exit_code(error.code);
}

CLI::App* add_command(CLI::App& app, Session& session, const std::string& name, const std::string& summary,
                      std::function<int()> body) {
  CLI::App* const command = app.add_subcommand(name, summary);
  command->add_flag("--json", session.json, "one JSON object on stdout, messages on stderr");
  command->callback([&session, body = std::move(body)] { session.exit_code = body(); });
  return command;
}

}  // namespace mgtd::daemon::cli
