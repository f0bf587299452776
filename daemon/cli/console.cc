// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/cli/ask.h"
#include "daemon/cli/command.h"

namespace mgtd::daemon::cli {
namespace {

int run_console(const Session& session) {
  const auto console = ask(session, ControlCommand::console);
  if (!console) return print_error(session, console.error());
  if (console->at("address").is_null())
    return print_error(session,
                       {ErrorCode::unreachable, "the daemon has no console",
                        "give it an address: listen in [console] of its configuration; its log says where "
                        "the address was occupied"});
  const std::string address = console->at("address"), token = console->at("token");
  const std::string url = address + "#token=" + token;
  if (session.json)
    print_json(
        {{"address", address}, {"token", token}, {"url", url}, {"refused", console->value("refused", 0)}});
  else
    fmt::print("{}\n", url);
  return 0;
}

}  // namespace

void add_console(CLI::App& app, Session& session) {
  add_command(app, session, "console",
              "the address of the daemon's page for a browser, with the token that lets it control the rig",
              [&session] { return run_console(session); });
}

}  // namespace mgtd::daemon::cli
