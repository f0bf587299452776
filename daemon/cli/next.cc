// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "calib/criticism/search/next_among.h"
#include "calib/effects/where.h"
#include "calib/poses/pose_list.h"
#include "calib/report/next_report.h"
#include "daemon/cli/command.h"
#include "daemon/cli/doubts.h"
#include "daemon/cli/fit_flags.h"
#include "daemon/cli/formulas.h"
#include "daemon/cli/next_hypotheses.h"
#include "daemon/cli/output_file.h"
#include "daemon/cli/work_progress.h"
#include "daemon/plan/plan_from_list.h"
#include "proto/run_request.h"

namespace mgtd::daemon::cli {
namespace {

constexpr const char* kNextHelp =
    "Two effects or formulas that look alike on this run may differ under other conditions. Each action of\n"
    "the menu is tried in the model: 24 poses more, and with them the probability that the right one of the\n"
    "two is named. Of several formulas each pair counts by its probabilities, attitudes are chosen for what\n"
    "they tell, and the actions stand in the order of what they gain a minute.\n\n"
    "  mgt next run.mgtrun                                               the names that explain left open;\n"
    "                                                                    else what mgt discover did\n"
    "  mgt next run.mgtrun axis.offset.drift axis.offset.temperature     a pair\n"
    "  mgt next run.mgtrun law1 'kink@s3.z,expr=max(0, T_degC - 24)'     formulas: kept ones, or new\n"
    "  mgt next run.mgtrun s3.z                                          what mgt discover left open there\n"
    "  mgt next run.mgtrun -o poses.csv                                  the best one's poses, as a list\n\n"
    "Exit code 0: something would help, or there is nothing to settle. 1: nothing known here would.";

struct NextArguments {
  std::string run, output;
  std::vector<std::string> pair;
  bool poses{false};
  std::shared_ptr<FitFlags> flags;
};

/// Where the verdict leaves nothing open: an effect of the model against the first that could stand in its
/// place, both asked about beside the others of the model.
Result<calib::criticism::search::NextReport> next_about(
    const PoseTable& table, calib::criticism::search::ExplainOptions search,
    const std::vector<calib::criticism::search::Choice>& doubts,
    calib::criticism::search::NextReport otherwise) {
  const auto open = std::find_if(
      doubts.begin(), doubts.end(),
      [](const calib::criticism::search::Choice& choice) { return !choice.alternatives.empty(); });
  if (open == doubts.end()) {
    if (!doubts.empty()) otherwise.nothing_to_settle.reset(), otherwise.none_helps = false;
    return otherwise;
  }
  std::erase_if(search.fit.effects,
                [&](const calib::effects::EffectPtr& e) { return e->spec() == open->spec; });
  return calib::criticism::search::next_of(
      table, search,
      std::pair{std::string(calib::effects::family_name(open->spec)),
                std::string(calib::effects::family_name(open->alternatives.front()))});
}

/// What the daemon takes to measure a step (run.start).
nlohmann::json run_of(const calib::criticism::search::NextStep& step) {
  const auto list = calib::poses::read_pose_list(calib::report::pose_list(step), "mgt next");
  if (!list) return {};
  RunRequest request;
  request.list = "mgt next";
  request.poses = plan::requested_poses(*list);
  return to_json(request);
}

using Report = Result<calib::criticism::search::NextReport>;

Report among(const Result<Question>& asked, const PoseTable& table) {
  if (!asked) return tl::unexpected(asked.error());
  return calib::criticism::search::next_among(table, asked->options, asked->hypotheses);
}

/// What the verdict and the model leave open; the formulas of a law where no name accounts for it.
Report left_open(const store::PoseSource& source, const calib::fit::FitOptions& options,
                 const std::vector<calib::criticism::search::Choice>& doubts) {
  using calib::criticism::search::Finding;
  const auto doubted = question_in_doubt(doubts, source, options);
  if (!doubted || !doubted->hypotheses.empty()) return among(doubted, source.table);
  const calib::criticism::search::ExplainOptions search{.fit = options, .also = formulas_of(source, options)};
  auto next = calib::criticism::search::next_of(source.table, search, std::nullopt);
  if (!next) return next;
  if (next->effect.empty() && !doubts.empty())
    return next_about(source.table, search, doubts, *std::move(next));
  const bool unexplained = next->finding == Finding::unknown || next->finding == Finding::partial;
  if (next->finding == Finding::bad_data || (!next->effect.empty() && !unexplained)) return next;
  const auto formulas = question_by_discovery("", source, options);
  return formulas && !formulas->hypotheses.empty() ? among(formulas, source.table) : next;
}

Report answer(const NextArguments& args, const store::PoseSource& source,
              const calib::fit::FitOptions& options,
              const std::vector<calib::criticism::search::Choice>& doubts) {
  if (args.pair.empty()) return left_open(source, options, doubts);
  if (args.pair.size() == 1) {
    const auto formulas = question_by_discovery(args.pair.front(), source, options);
    if (formulas && formulas->hypotheses.empty())
      return fail(ErrorCode::refused, "mgt discover leaves no two formulas open at " + args.pair.front(),
                  "mgt next without a name asks about the whole run");
    return among(formulas, source.table);
  }
  if (!names_of_the_library(args.pair, source))
    return among(question_of(args.pair, source, options), source.table);
  return calib::criticism::search::next_of(source.table,
                                           {.fit = options, .also = formulas_of(source, options)},
                                           std::pair{args.pair[0], args.pair[1]});
}

int run_next(const Session& session, const NextArguments& args) {
  const bool place = args.pair.size() == 1 && calib::effects::Where::parse(args.pair.front());
  if (args.pair.size() == 1 && !place)
    return print_error(session,
                       {ErrorCode::usage, "one effect alone leaves nothing to settle",
                        "name two, or none; a place (s3.z) asks about what mgt discover finds there"});
  const auto output = OutputFile::at(args.output, files_read(args.run, *args.flags));
  if (!output) return print_error(session, output.error());
  const auto source = read_source(args.run, *args.flags);
  if (!source) return print_error(session, source.error());
  const auto options = fit_options(*args.flags, *source);
  if (!options) return print_error(session, options.error());
  const auto doubts = doubts_of(args.run, *source, *options);
  if (!doubts) return print_error(session, doubts.error());
  const auto next = with_progress("next", *options, [&](const calib::fit::FitOptions& told) {
    return answer(args, *source, told, *doubts);
  });
  if (!next) return print_error(session, next.error());
  if (!next->steps.empty()) {
    const calib::criticism::search::NextStep& best = next->steps.front();
    const std::string what = fmt::format("{} poses ({})", best.poses.size(), best.measurement.action);
    if (auto written = output->write(calib::report::pose_list(best), what); !written)
      return print_error(session, written.error());
  }
  if (session.json) {
    nlohmann::json out = calib::report::to_json(*next);
    out["chosen_in_doubt"] = doubts_json(*doubts);
    for (std::size_t i = 0; args.poses && i < next->steps.size(); ++i)
      out["next"][i]["run"] = run_of(next->steps[i]);
    print_json(out);
  } else {
    print_text(session, doubts_text(*doubts) + calib::report::to_text(*next));
  }
  return next->none_helps ? 1 : 0;
}

}  // namespace

void add_next(CLI::App& app, Session& session) {
  auto args = std::make_shared<NextArguments>();
  CLI::App* const command =
      add_command(app, session, "next", "the cheapest further measurement that would settle the name",
                  [args, &session] { return run_next(session, *args); });
  command->footer(kNextHelp);
  command->add_option("RUN", args->run, "*.mgtrun or a pose table in CSV")->required();
  command->add_option("EFFECT", args->pair, "two effects or formulas, by name or spec; or a place")
      ->expected(0, 2);
  command->add_option("-o,--output", args->output, "write the poses of the best one here (CSV)");
  command->add_flag("--poses", args->poses, "with --json: each as the arguments of a run that measures it");
  args->flags = add_model_flags(command);
}

}  // namespace mgtd::daemon::cli
