// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "calib/report/parameter_history.h"
#include "daemon/cli/ask.h"
#include "daemon/cli/calibration_file.h"
#include "daemon/cli/output_file.h"
#include "daemon/cli/work_progress.h"

namespace mgtd::daemon::cli {
namespace {

constexpr const char* kHistoryHelp =
    R"(Without files it asks the daemon: who proposed, accepted, rejected and rolled back which calibration, when and
why, and how the parameters moved from each to the next. With files (CAL.json, or runs that are then fitted with
the same options) it says how the parameters moved, in the order of time. A line per sensor has of each kind of
parameter the one that moved most in standard errors; --json has all of them.

  mgt history --figure history.svg)";

struct HistoryArguments {
  std::vector<std::string> files;
  std::string figure;
  std::shared_ptr<FitFlags> flags;
};

std::string decision_line(const nlohmann::json& d) {
  const std::string by = d.at("by"), why = d.at("why"), origin = d.at("origin");
  return fmt::format("{}Z  {:<14} {:<11} by {}{}{}{}\n", d.at("t").get<std::string>().substr(0, 19),
                     d.at("id").get<std::string>(), d.at("event").get<std::string>(),
                     by.empty() ? "somebody not recorded" : by, origin.empty() ? "" : ", from " + origin,
                     d.at("forced") == true ? ", although it failed its checks" : "",
                     why.empty() ? "" : ", because: " + why);
}

std::string history_text(const nlohmann::json& history) {
  std::string out;
  if (history.contains("decisions")) {
    for (const auto& d : history.at("decisions")) out += decision_line(d);
    if (history.at("decisions").empty()) out += "no calibrations yet: mgt run start proposes one\n";
  }
  for (const auto& m : history.at("moves"))
    out += (out.empty() ? "" : "\n") + m.at("text").get<std::string>();
  if (history.contains("unreadable"))
    for (const auto& id : history.at("unreadable"))
      out += fmt::format("note: the file of calibration {} cannot be read\n", id.get<std::string>());
  if (history.at("figure").is_object())
    out += fmt::format("\nA good history: {}\n", history.at("figure").at("good").get<std::string>());
  return out;
}

Result<nlohmann::json> history_of_files(const HistoryArguments& args) {
  if (args.files.size() < 2)
    return fail(ErrorCode::usage, "one calibration has no history",
                "name two or more, or none to ask the daemon");
  const auto flags = with_places_of(args.files, *args.flags);
  if (!flags) return tl::unexpected(flags.error());
  std::vector<calib::calibration::Calibration> all;
  for (const std::string& path : args.files) {
    auto calibration = with_progress("history", [&] { return calibration_of(path, *flags); });
    if (!calibration) return tl::unexpected(calibration.error());
    all.push_back(*std::move(calibration));
    const store::PlacedFile first{args.files.front(), all.front().geometry};
    if (auto ok = continues(first, all.back(), path); !ok) return tl::unexpected(ok.error());
  }
  const auto moves = calib::report::moves_among(std::move(all));
  auto told = nlohmann::json::array();
  for (const auto& m : moves) told.push_back(calib::report::to_json(m));
  const auto figure = calib::report::history_of(moves);
  return nlohmann::json{{"moves", std::move(told)},
                        {"figure", figure ? calib::report::to_json(*figure) : nlohmann::json()}};
}

int run_history(const Session& session, const HistoryArguments& args) {
  std::vector<std::string> read = args.files;
  read.push_back(args.flags->array.array);
  const auto output = OutputFile::at(args.figure, read, "--figure");
  if (!output) return print_error(session, output.error());
  auto history =
      args.files.empty() ? ask(session, ControlCommand::calibrations_history) : history_of_files(args);
  if (!history) return print_error(session, history.error());
  if (output->wanted()) {
    if (!history->at("figure").is_object())
      return print_error(session, {ErrorCode::refused,
                                   "there is no figure: no parameter moved from one calibration to another",
                                   "it takes two calibrations of this array that were not rejected"});
    if (auto written = output->write(history->at("figure").at("svg"), "figure"); !written)
      return print_error(session, written.error());
  }
  if (session.json) {
    (*history)["schema"] = "mgt.history/1";
    print_json(*history);
    return 0;
  }
  print_text(session, history_text(*history));
  return 0;
}

}  // namespace

void add_history(CLI::App& app, Session& session) {
  auto args = std::make_shared<HistoryArguments>();
  CLI::App* const command = add_command(
      app, session, "history", "the calibrations of a rig: who decided what, and how the parameters moved",
      [args, &session] { return run_history(session, *args); });
  command->footer(kHistoryHelp);
  command->add_option("CALIBRATION", args->files,
                      "CAL.json, *.mgtrun or pose tables; none: those of the daemon");
  command->add_option("--figure", args->figure, "write the figure to this file, as SVG");
  args->flags = add_fit_flags_of_several(command);
}

}  // namespace mgtd::daemon::cli
