// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/explain.h"

#include <fmt/format.h>

#include <algorithm>

#include "calib/criticism/explain_json.h"
#include "calib/criticism/explain_text.h"
#include "calib/criticism/resemblance.h"
#include "calib/pose_table.h"
#include "daemon/cli/command.h"
#include "daemon/cli/fit_flags.h"

namespace mgtd::cli {
namespace {

constexpr const char* kHelp =
    "Verdicts: PASS nothing stands out; EXPLAINED one effect accounts for it; AMBIGUOUS several could;\n"
    "PARTIAL effects were found and more is there, or it takes more than one; UNKNOWN something that is in "
    "no\n"
    "library; BAD-DATA.\n"
    "One clean run in a hundred is called something other than PASS.\n\n"
    "Columns: k coefficients; d and p how far beyond chance; share the part of the excess of chi-square "
    "that\n"
    "the effect would take away (1: all of it; -: these poses do not tell their noise, and nothing was "
    "found).\n\n"
    "  mgt explain run.mgtrun\n"
    "  mgt explain run.mgtrun --with site.gradient     what is missing beside a gradient of the site\n\n"
    "Exit code 0: PASS. 1: any other verdict.";

struct Arguments {
  std::string run;
  std::shared_ptr<FitFlags> flags;
};

/// Formulas of the run file that its poses can feed and that are not in the model.
std::vector<calib::Suspect> formulas_of(const daemon::PoseSource& source, const calib::FitOptions& options) {
  std::vector<calib::Suspect> out;
  for (const daemon::Definition& d : source.definitions) {
    const bool known = std::any_of(options.effects.begin(), options.effects.end(),
                                   [&](const calib::EffectPtr& e) { return e->name() == d.name; });
    const auto spec = calib::EffectSpec::parse(d.spec);
    if (known || !spec) continue;
    auto suspect = calib::formula_suspect(*spec);
    if (!suspect || !suspect->variants.front()->check(source.table)) continue;
    if (d.exploratory() && d.found_on == calib::data_hash(source.table))
      fmt::print(stderr, "{} was thought of on this run: what is said of it here is exploratory\n", d.name);
    out.push_back(std::move(*suspect));
  }
  return out;
}

int run_explain(const Session& session, const Arguments& args) {
  const auto source = read_source(args.run, *args.flags);
  if (!source) return report(session, source.error());
  const auto options = fit_options(*args.flags, *source);
  if (!options) return report(session, options.error());
  const auto explained =
      calib::explain(source->table, {.fit = *options, .also = formulas_of(*source, *options)});
  if (!explained) return report(session, explained.error());
  if (session.json) {
    print_json(calib::to_json(*explained));
  } else {
    fmt::print("{}", calib::to_text(*explained));
  }
  return explained->finding == calib::Finding::pass ? 0 : 1;
}

}  // namespace

void add_explain(CLI::App& app, Session& session) {
  auto args = std::make_shared<Arguments>();
  CLI::App* const command =
      add_command(app, session, "explain", "which physical effect is missing, and what cannot be told",
                  [args, &session] { return run_explain(session, *args); });
  command->footer(kHelp);
  command->add_option("RUN", args->run, "*.mgtrun or a pose table in CSV")->required();
  args->flags = add_model_flags(command);
}

}  // namespace mgtd::cli
