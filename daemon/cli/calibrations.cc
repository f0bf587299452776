// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "calib/calibration/calibration_json.h"
#include "calib/report/calibration_text.h"
#include "daemon/cli/ask.h"
#include "daemon/cli/calibration_file.h"
#include "daemon/cli/meant_calibration.h"

namespace mgtd::daemon::cli {
namespace {

int print_list(const Session& session) {
  const auto reply = ask(session, ControlCommand::calibrations_list);
  if (!reply) return print_error(session, reply.error());
  if (session.json) {
    print_json(*reply);
    return 0;
  }
  std::string text;
  if (reply->at("calibrations").empty()) text = "no calibrations yet: mgt run start proposes one\n";
  for (const auto& c : reply->at("calibrations")) {
    const std::string why = c.value("why", "");
    text +=
        fmt::format("{:<14} {:<9} since {}  from {}{}{}\n", c.at("id").get<std::string>(),
                    c.at("state").get<std::string>(), c.at("since").get<std::string>().substr(0, 19),
                    c.at("origin").get<std::string>(), c.at("forced") == true ? "  (failed its checks)" : "",
                    why.empty() ? "" : "  because: " + why);
  }
  print_text(session, text);
  return 0;
}

/// The id that the operator means.
Result<std::string> resolve(const Session& session, const std::string& word) {
  const auto reply = ask(session, ControlCommand::calibrations_list);
  if (!reply) return tl::unexpected(reply.error());
  return meant_calibration(word, reply->at("calibrations"));
}

int print_reply(const Session& session, const Result<nlohmann::json>& reply, std::string_view done) {
  if (!reply) return print_error(session, reply.error());
  if (session.json) {
    print_json(*reply);
  } else if (reply->contains("active")) {
    fmt::print("calibration {} is {}\n", reply->at("active").get<std::string>(), done);
  } else if (reply->contains("rejected")) {
    fmt::print("calibration {} is {}\n", reply->at("rejected").get<std::string>(), done);
  } else {
    fmt::print("{}\n", reply->dump(1));
  }
  return 0;
}

struct CalibrationsArguments {
  std::string id, file, why;
  bool force{false}, accept{false};
};

int show(const Session& session, const CalibrationsArguments& args) {
  const auto id = resolve(session, args.id);
  if (!id) return print_error(session, id.error());
  const auto reply = ask(session, ControlCommand::calibrations_show, {{"id", *id}});
  if (!reply) return print_error(session, reply.error());
  if (session.json) {
    print_json(*reply);
    return 0;
  }
  const auto calibration = calib::calibration::calibration_from_json(*reply);
  if (!calibration) return print_error(session, calibration.error());
  print_text(session, calib::report::to_text(*calibration, table_width(session)));
  return 0;
}

int accept(const Session& session, const CalibrationsArguments& args) {
  const auto id = resolve(session, args.id);
  if (!id) return print_error(session, id.error());
  const nlohmann::json wanted{{"id", *id}, {"force", args.force}, {"why", args.why}};
  return print_reply(session, ask(session, ControlCommand::calibrations_accept, wanted), "active");
}

int reject(const Session& session, const CalibrationsArguments& args) {
  const auto id = resolve(session, args.id);
  if (!id) return print_error(session, id.error());
  return print_reply(session,
                     ask(session, ControlCommand::calibrations_reject, {{"id", *id}, {"why", args.why}}),
                     "rejected");
}

int import_file(const Session& session, const CalibrationsArguments& args) {
  const auto calibration = read_calibration(args.file);
  if (!calibration) return print_error(session, calibration.error());
  const auto reply = ask(session, ControlCommand::calibrations_import,
                         {{"calibration", calib::calibration::to_json(*calibration)},
                          {"origin", std::filesystem::path(args.file).filename().string()},
                          {"accept", args.accept},
                          {"force", args.force}});
  if (session.json || !reply || reply->contains("active")) return print_reply(session, reply, "active");
  const std::string id = reply->at("id");
  fmt::print("calibration {0} is proposed: mgt calibrations accept {0}\n", id);
  return 0;
}

}  // namespace

void add_calibrations(CLI::App& app, Session& session) {
  CLI::App* const group = app.add_subcommand(
      "calibrations", "calibrations of the daemon: list, show, import, accept, reject, rollback");
  group->require_subcommand(1);
  add_command(*group, session, "list", "every calibration and its state",
              [&session] { return print_list(session); });
  const auto args = std::make_shared<CalibrationsArguments>();
  CLI::App* const shown = add_command(*group, session, "show", "one calibration, whole",
                                      [args, &session] { return show(session, *args); });
  shown->add_option("ID", args->id, "its id or the beginning of it, or 'latest' for the newest proposal")
      ->required();
  CLI::App* const imported =
      add_command(*group, session, "import", "propose a calibration that was made elsewhere",
                  [args, &session] { return import_file(session, *args); });
  imported->add_option("CAL.json", args->file, "written by mgt fit -o or mgt improve -o")->required();
  imported->add_flag("--accept", args->accept, "make it the active one at once");
  imported->add_flag("--force", args->force, "even if it failed its checks; every sample then says so");
  CLI::App* const accepted =
      add_command(*group, session, "accept", "make a proposed calibration the active one",
                  [args, &session] { return accept(session, *args); });
  accepted->add_option("ID", args->id, "its id or the beginning of it, or 'latest' for the newest proposal")
      ->required();
  accepted->add_flag("--force", args->force, "even if it failed its checks; every sample then says so");
  accepted->add_option("--why", args->why, "the reason, kept with it and shown in the list");
  CLI::App* const rejected =
      add_command(*group, session, "reject", "take a proposed calibration off the proposals; its file stays",
                  [args, &session] { return reject(session, *args); });
  rejected->add_option("ID", args->id, "its id or the beginning of it, or 'latest' for the newest proposal")
      ->required();
  rejected->add_option("--why", args->why, "the reason, kept with it and shown in the list")->required();
  add_command(*group, session, "rollback", "go back to the calibration that was active before", [&session] {
    return print_reply(session, ask(session, ControlCommand::calibrations_rollback), "active again");
  });
}

}  // namespace mgtd::daemon::cli
