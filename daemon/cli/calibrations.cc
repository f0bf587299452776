// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <memory>

#include "daemon/cli/ask.h"

namespace mgtd::cli {
namespace {

int print_list(const Session& session) {
  const auto reply = ask(session, ControlCommand::calibrations_list);
  if (!reply) return report(session, reply.error());
  if (session.json) {
    print_json(*reply);
    return 0;
  }
  if (reply->at("calibrations").empty()) fmt::print("no calibrations yet: mgt run start proposes one\n");
  for (const auto& c : reply->at("calibrations")) {
    fmt::print("{:<14} {:<9} since {}  from {}\n", c.at("id").get<std::string>(),
               c.at("state").get<std::string>(), c.at("since").get<std::string>().substr(0, 19),
               c.at("origin").get<std::string>());
  }
  return 0;
}

/// "latest" is the newest proposal.
Result<std::string> resolve(const Session& session, const std::string& id) {
  if (id != "latest") return id;
  const auto reply = ask(session, ControlCommand::calibrations_list);
  if (!reply) return tl::unexpected(reply.error());
  std::string found, since;
  for (const auto& c : reply->at("calibrations")) {
    if (c.at("state") != "proposed" || c.at("since").get<std::string>() < since) continue;
    since = c.at("since");
    found = c.at("id");
  }
  if (found.empty())
    return fail(ErrorCode::state, "no calibration is proposed", "mgt run start proposes one");
  return found;
}

int print_reply(const Session& session, const Result<nlohmann::json>& reply, std::string_view done) {
  if (!reply) return report(session, reply.error());
  if (session.json) {
    print_json(*reply);
  } else if (reply->contains("active")) {
    fmt::print("calibration {} is {}\n", reply->at("active").get<std::string>(), done);
  } else {
    fmt::print("{}\n", reply->dump(1));
  }
  return 0;
}

int with_id(const Session& session, const std::string& wanted, ControlCommand command,
            std::string_view done) {
  const auto id = resolve(session, wanted);
  if (!id) return report(session, id.error());
  return print_reply(session, ask(session, command, {{"id", *id}}), done);
}

}  // namespace

void add_calibrations(CLI::App& app, Session& session) {
  CLI::App* const group =
      app.add_subcommand("calibrations", "calibrations of the daemon: list, show, accept, rollback");
  group->require_subcommand(1);
  add_command(*group, session, "list", "every calibration and its state",
              [&session] { return print_list(session); });
  auto id = std::make_shared<std::string>();
  CLI::App* const show = add_command(*group, session, "show", "one calibration, whole", [id, &session] {
    return with_id(session, *id, ControlCommand::calibrations_show, "");
  });
  show->add_option("ID", *id, "or 'latest': the newest proposal")->required();
  CLI::App* const accept = add_command(
      *group, session, "accept", "make a proposed calibration the active one",
      [id, &session] { return with_id(session, *id, ControlCommand::calibrations_accept, "active"); });
  accept->add_option("ID", *id, "or 'latest': the newest proposal")->required();
  add_command(*group, session, "rollback", "back to the calibration that was active before", [&session] {
    return print_reply(session, ask(session, ControlCommand::calibrations_rollback), "active again");
  });
}

}  // namespace mgtd::cli
