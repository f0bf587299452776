// SPDX-License-Identifier: Apache-2.0
// Commands that show who has control of the daemon, keep it, or take it away.
#include <fmt/format.h>
#include <pwd.h>
#include <nlohmann/json.hpp>

#include <csignal>
#include <memory>
#include <thread>

#include "daemon/cli/ask.h"
#include "daemon/cli/interrupt.h"

namespace mgtd::daemon::cli {
namespace {

constexpr auto kBetweenSigns = std::chrono::milliseconds(500);
constexpr double kSilence_s = 10;  // a holder that hangs or is stopped loses control after it

std::string user_name(std::int64_t uid) {
  const passwd* const user = uid < 0 ? nullptr : ::getpwuid(static_cast<uid_t>(uid));
  return user == nullptr ? fmt::format("uid {}", uid) : user->pw_name;
}

std::string in_words(const nlohmann::json& holder) {
  if (holder.is_null()) return "nobody has control; whoever changes something next gets it";
  const std::string why = holder.at("why"), via = holder.value("via", "");
  const std::string who = via.empty() ? fmt::format("{} (pid {})", user_name(holder.at("uid")),
                                                    holder.at("pid").get<std::int64_t>())
                                      : via;
  return fmt::format("{} has control since {}{}{}", who, holder.at("since").get<std::string>(),
                     holder.at("taken") == true ? ", on request" : ", by a command",
                     why.empty() ? "" : ": " + why);
}

int show(const Session& session) {
  const auto status = ask(session, ControlCommand::status);
  if (!status) return print_error(session, status.error());
  const nlohmann::json& holder = status->at("control").at("holder");
  if (session.json)
    print_json({{"holder", holder}});
  else
    fmt::print("{}\n", in_words(holder));
  return 0;
}

int take_away(const Session& session) {
  const auto reply = ask(session, ControlCommand::control_break);
  if (!reply) return print_error(session, reply.error());
  if (session.json)
    print_json(*reply);
  else
    fmt::print("{}\n", reply->at("was").is_null()
                           ? std::string("nobody had control")
                           : "control taken away; until now: " + in_words(reply->at("was")));
  return 0;
}

/// Keeps control until Ctrl-C, or until somebody takes it away.
int hold(const Session& session, const std::string& why) {
  catch_interrupts({SIGINT, SIGTERM});
  auto client = serve::ControlClient::connect(session.control_socket);
  if (!client) return print_error(session, client.error());
  const auto mine = client->request(ControlCommand::control_take, {{"why", why}, {"idle_s", kSilence_s}});
  if (!mine) return print_error(session, mine.error());
  if (session.json) print_json(*mine);
  fmt::print(stderr, "control is yours until Ctrl-C; others can look, pause and abort\n");
  while (!interrupted()) {
    std::this_thread::sleep_for(kBetweenSigns);
    const auto status = client->request(ControlCommand::status);
    if (!status) return print_error(session, status.error());
    const nlohmann::json& holder = status->at("control").at("holder");
    if (!holder.is_null() && holder.at("since") == mine->at("since") && holder.at("pid") == mine->at("pid"))
      continue;
    return print_error(session, {ErrorCode::state, "control was taken away; now " + in_words(holder), ""});
  }
  return 0;
}

}  // namespace

void add_control(CLI::App& app, Session& session) {
  CLI::App* const group =
      app.add_subcommand("control", "who may change things now: one controls, many look; show, hold, break");
  group->require_subcommand(1);
  add_command(*group, session, "show", "who has control, and since when",
              [&session] { return show(session); });
  auto why = std::make_shared<std::string>();
  CLI::App* const held =
      add_command(*group, session, "hold",
                  "keep everyone else from starting or changing anything until Ctrl-C, for instance while "
                  "somebody works at the table",
                  [why, &session] { return hold(session, *why); });
  held->add_option("--why", *why, "the reason, shown to everyone who is refused");
  add_command(*group, session, "break", "take control away from whoever has it",
              [&session] { return take_away(session); });
}

}  // namespace mgtd::daemon::cli
