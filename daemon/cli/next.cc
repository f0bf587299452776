// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "calib/criticism/next_pair.h"
#include "daemon/cli/command.h"
#include "daemon/cli/fit_flags.h"

namespace mgtd::cli {
namespace {

constexpr const char* kHelp =
    "Two effects that look alike on this run may differ under other conditions. Each action of the menu is "
    "tried\n"
    "in the model: 24 poses more, and with them the probability that the right one of the two is named.\n\n"
    "  mgt next run.mgtrun                                               what the verdict left open\n"
    "  mgt next run.mgtrun axis.offset.drift axis.offset.temperature     a pair\n"
    "  mgt next run.mgtrun -o poses.csv                                  the best one's poses, as a list\n\n"
    "Exit code 0: something would help, or there is nothing to settle. 1: nothing known here would.";

struct Arguments {
  std::string run, output;
  std::vector<std::string> pair;
  std::shared_ptr<FitFlags> flags;
};

int run_next(const Session& session, const Arguments& args) {
  if (args.pair.size() == 1)
    return report(session,
                  {ErrorCode::usage, "one effect alone leaves nothing to settle", "name two, or none"});
  for (const std::string& name : args.pair) {
    if (name.find_first_of("@,") == std::string::npos) continue;
    return report(session,
                  {ErrorCode::usage, fmt::format("'{}': two effects are compared wherever they act", name),
                   "name them without place and numbers, like " + name.substr(0, name.find_first_of("@,"))});
  }
  const auto source = read_source(args.run, *args.flags);
  if (!source) return report(session, source.error());
  const auto options = fit_options(*args.flags, *source);
  if (!options) return report(session, options.error());
  std::optional<std::pair<std::string, std::string>> pair;
  if (args.pair.size() == 2) pair = {args.pair[0], args.pair[1]};
  const auto next = calib::next_of(source->table, {.fit = *options}, pair);
  if (!next) return report(session, next.error());
  if (!args.output.empty() && !next->steps.empty()) {
    const calib::NextStep& best = next->steps.front();
    if (auto written = write_file(args.output, calib::pose_list(best)); !written)
      return report(session, written.error());
    fmt::print(stderr, "{} poses written to {}: {}\n", best.poses.size(), args.output,
               best.measurement.action);
  }
  if (session.json) {
    print_json(to_json(*next));
  } else {
    fmt::print("{}", to_text(*next));
  }
  return next->steps.empty() && !next->effect.empty() ? 1 : 0;
}

}  // namespace

void add_next(CLI::App& app, Session& session) {
  auto args = std::make_shared<Arguments>();
  CLI::App* const command =
      add_command(app, session, "next", "the cheapest further measurement that would settle the name",
                  [args, &session] { return run_next(session, *args); });
  command->footer(kHelp);
  command->add_option("RUN", args->run, "*.mgtrun or a pose table in CSV")->required();
  command->add_option("EFFECT", args->pair, "two of them, by name")->expected(0, 2);
  command->add_option("-o,--output", args->output, "write the best one's poses here (CSV)");
  args->flags = add_model_flags(command);
}

}  // namespace mgtd::cli
