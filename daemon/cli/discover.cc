// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "calib/discovery/discover.h"
#include "calib/report/discovery_report.h"
#include "daemon/cli/command.h"
#include "daemon/cli/fit_flags.h"
#include "daemon/cli/keep_discovery.h"
#include "daemon/cli/searched_model.h"
#include "daemon/cli/work_progress.h"

namespace mgtd::daemon::cli {
namespace {

using nlohmann::json;

constexpr const char* kDiscoverHelp =
    "Looks for a law that is in no library: tries every formula of a fixed grammar on every axis, sensor "
    "and\n"
    "on the array, and says which one the readings follow, how sure that is, and what else it could be.\n\n"
    "  mgt discover run.mgtrun\n"
    "  mgt discover run.mgtrun --with axis.gain.temperature\n"
    "  mgt discover run.mgtrun --spec        the effects, as mgt fit --with reads them\n"
    "  mgt discover run.mgtrun --keep        the formulas stay in the run file, the search in its report\n\n"
    "PASS         nothing stands out from noise\n"
    "LAW          one formula, nothing left after it\n"
    "LAW-SET      several formulas that these poses do not tell apart\n"
    "LIBRARY      an effect of the library describes it: mgt explain\n"
    "SHAPE-ONLY   something acts, and no formula accounts for it\n"
    "NOISE-LIKE   an offset that walks or jumps describes it better\n\n"
    "In formulas T is the sensor's own temperature, x, y, z its readings without offset over 50 000 nT, t_h\n"
    "hours since the start. A formula says what the readings depend on, never why.\n\n"
    "Exit code 0: PASS, LAW, LAW-SET or LIBRARY; 1: SHAPE-ONLY or NOISE-LIKE.";

struct DiscoverArguments {
  std::string run;
  int draws{2000};
  bool spec{false}, quick{false}, keep{false};
  std::shared_ptr<FitFlags> flags;
};

int run_discover(const Session& session, const DiscoverArguments& args) {
  using calib::discovery::LawFinding;
  auto source = read_source(args.run, *args.flags);
  if (!source) return print_error(session, source.error());
  if (args.keep) {  // refused before the search, not after it
    if (const auto file = open_to_keep(args.run, *source); !file) return print_error(session, file.error());
  }
  const auto options = fit_options(*args.flags, *source);
  if (!options) return print_error(session, options.error());
  const auto found = with_progress("discover", *options, [&](const calib::fit::FitOptions& told) {
    return calib::discovery::discover(source->table,
                                      {.fit = told, .draws = args.draws, .checks = !args.quick});
  });
  if (!found) return print_error(session, found.error());
  const auto before = commands_to_model(options->effects, *source, args.run);
  std::vector<std::string> names;
  if (args.keep) {
    auto file = open_to_keep(args.run, *source);
    if (!file) return print_error(session, file.error());
    auto formulas =
        keep_discovery(*file, *source, *options, *found, calib::report::to_json(*found, args.run, before));
    if (!formulas) return print_error(session, formulas.error());
    names = *std::move(formulas);
  }
  if (session.json) {
    json object = calib::report::to_json(*found, args.run, before, names);
    if (args.keep) object["kept"] = names;
    print_json(object);
  } else if (args.spec) {
    for (const auto& law : found->laws)
      for (const std::string& spec : law.formulas.front().specs) fmt::print("{}\n", spec);
  } else {
    print_text(session, calib::report::to_text(*found, args.run, before, names));
  }
  if (args.keep && !session.json && names.empty())
    fmt::print("the search is kept in {}: mgt report shows it; there is no formula to keep\n", args.run);
  return found->finding == LawFinding::shape_only || found->finding == LawFinding::noise_like ? 1 : 0;
}

}  // namespace

void add_discover(CLI::App& app, Session& session) {
  auto args = std::make_shared<DiscoverArguments>();
  CLI::App* const command =
      add_command(app, session, "discover", "the formula of a law that is in no library",
                  [args, &session] { return run_discover(session, *args); });
  command->footer(kDiscoverHelp);
  command->add_option("RUN", args->run, "*.mgtrun or a pose table in CSV")->required();
  command->add_option("--draws", args->draws, "draws of noise that calibrate the search")
      ->check(CLI::Range(200, 100'000))
      ->capture_default_str();
  command->add_flag("--spec", args->spec, "only the effects, one a line, as --with reads them");
  CLI::Option* const quick =
      command->add_flag("--quick", args->quick, "without the fit with the law, the folds and the halves");
  command
      ->add_flag("--keep", args->keep,
                 "keep the leading formulas, with their probability and what else they could be, and the "
                 "search for mgt report")
      ->excludes(quick);
  args->flags = add_model_flags(command);
}

}  // namespace mgtd::daemon::cli
