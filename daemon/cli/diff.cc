// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "calib/criticism/tests/exchange_in_run.h"
#include "calib/report/change_report.h"
#include "calib/report/diff_report.h"
#include "calib/report/rearrangement_text.h"
#include "daemon/cli/calibration_file.h"
#include "daemon/cli/command.h"
#include "daemon/cli/work_progress.h"

namespace mgtd::daemon::cli {
namespace {

constexpr const char* kDiffHelp =
    R"(Both runs are fitted with the same options (or taken as they are when a file is a CAL.json) and compared with
the uncertainty of both. A turn of the whole array, on its table or in its coil cage, is taken out first: it
is no change of the array. The answer allows for the number of parameters looked at: two runs of an unchanged
rig are called different in about one case of a hundred. Effects that both have are compared too.

  mgt diff monday.mgtrun friday.mgtrun --with site.gradient

Exit code 0: nothing changed that these runs can tell. 1: changed.)";
constexpr std::size_t kChangesShown = 12;

struct DiffArguments {
  std::string a, b;
  std::shared_ptr<FitFlags> flags;
};

int run_diff(const Session& session, const DiffArguments& args) {
  const auto flags = with_places_of({args.a, args.b}, *args.flags);
  if (!flags) return print_error(session, flags.error());
  const auto taken = [&](const std::string& path) {
    return with_progress("diff", [&] { return calibration_of(path, *flags); });
  };
  const auto a = taken(args.a);
  if (!a) return print_error(session, a.error());
  const auto b = taken(args.b);
  if (!b) return print_error(session, b.error());
  if (auto same = store::same_array({args.a, a->geometry}, {args.b, b->geometry},
                                    "compare calibrations of one array");
      !same)
    return print_error(session, same.error());
  for (const auto* c : {&*a, &*b}) {
    if (!c->accepted_by_checks)
      fmt::print(stderr, "warning: {} fails its own checks; see mgt fit\n", c == &*a ? args.a : args.b);
  }
  const calib::validity::DiffReport found = calib::validity::diff(*a, *b);
  std::vector<std::string> remarks = calib::report::remarks_of(found);
  if (const auto exchanged = calib::criticism::tests::exchanged_since(*a, *b))
    remarks.push_back(fmt::format("{}: the scales, angles and offsets have moved with them",
                                  calib::report::rearrangement_text(*exchanged)));
  if (session.json) {
    print_json({{"schema", "mgt.diff/1"},
                {"a", a->id},
                {"b", b->id},
                {"changed", found.changed},
                {"conclusion", calib::report::conclusion_text(found)},
                {"remarks", remarks},
                {"change", calib::report::to_json(found.change)}});
  } else {
    std::string text =
        fmt::format("{}\n\n{}\n", calib::report::conclusion_text(found),
                    calib::report::change_table(found.change, kChangesShown, table_width(session)));
    for (const std::string& remark : remarks) text += "note: " + remark + "\n";
    print_text(session, text);
  }
  return found.changed ? 1 : 0;
}

}  // namespace

void add_diff(CLI::App& app, Session& session) {
  auto args = std::make_shared<DiffArguments>();
  CLI::App* const command = add_command(
      app, session, "diff", "has the calibration changed between two runs, and in which parameter?",
      [args, &session] { return run_diff(session, *args); });
  command->footer(kDiffHelp);
  command->add_option("RUN_A", args->a, "*.mgtrun, a pose table in CSV, or a CAL.json")->required();
  command->add_option("RUN_B", args->b, "the later one")->required();
  args->flags = add_fit_flags_of_several(command);
}

}  // namespace mgtd::daemon::cli
