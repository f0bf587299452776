// SPDX-License-Identifier: Apache-2.0
#include "calib/validity/validity_check.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "calib/report/change_report.h"
#include "calib/report/residual_words.h"
#include "calib/report/validity_report.h"
#include "daemon/cli/calibration_file.h"
#include "daemon/cli/command.h"
#include "daemon/cli/work_progress.h"

namespace mgtd::daemon::cli {
namespace {

constexpr const char* kCheckHelp =
    R"(A dozen poses in different attitudes suffice; table angles are not needed unless the calibration holds an
effect of the site, platform or table. The whole array may have been mounted again, and elsewhere; where the
reference is a vector, the answer says how the array is turned since. It weighs both the noise of these poses
and the uncertainty of the calibration: an unchanged rig is called changed in about one case of a hundred.
Printed beside it: the smallest change that would have been seen, and which sensor and parameter moved.

  mgt check cal.json dozen.csv && echo go on

Exit code 0: valid. 1: not valid, calibrate again.)";
constexpr std::size_t kPosesShown = 8;

struct CheckArguments {
  std::string calibration, run;
  std::shared_ptr<FitFlags> flags;
};

std::string text_of(const calib::validity::ValidityReport& checked, std::size_t width) {
  std::string out = fmt::format("calibration {} against {} poses: {}\n", checked.calibration, checked.poses,
                                checked.valid ? "VALID" : "NOT VALID");
  out += fmt::format("residual {:.3g} nT ({}); noise of a pose mean {:.3g} nT, {}\n", checked.residual_nT,
                     calib::report::kResidualIs, checked.noise_nT,
                     checked.noise_from_dwells
                         ? "the larger of what the dwells tell and what the calibration's own run left"
                         : "of the calibration's own run");
  out += calib::report::change_table(checked.change, kPosesShown, width) + "\n";
  for (const std::string& reason : calib::report::validity_reasons(checked))
    out += fmt::format("note: {}\n", reason);
  return out;
}

int run_check(const Session& session, const CheckArguments& args) {
  const auto calibration = read_calibration(args.calibration);
  if (!calibration) return print_error(session, calibration.error());
  const auto source = store::read_run(args.run);
  if (!source) return print_error(session, source.error());
  tell_masked(*source);
  if (auto same = same_array(*calibration, args.calibration, *source); !same)
    return print_error(session, same.error());
  const auto options = fit_options(*args.flags, *source);
  if (!options) return print_error(session, options.error());
  const auto checked = with_progress("check", *options, [&](const calib::fit::FitOptions& told) {
    return calib::validity::check(*calibration, source->table, told);
  });
  if (!checked) return print_error(session, checked.error());
  if (session.json) {
    print_json(calib::report::to_json(*checked));
  } else {
    print_text(session, text_of(*checked, table_width(session)));
  }
  return checked->valid ? 0 : 1;
}

}  // namespace

void add_check(CLI::App& app, Session& session) {
  auto args = std::make_shared<CheckArguments>();
  CLI::App* const command =
      add_command(app, session, "check", "is this calibration still valid? (a dozen poses suffice)",
                  [args, &session] { return run_check(session, *args); });
  command->footer(kCheckHelp);
  command->add_option("CAL", args->calibration, "CAL.json of mgt fit -o")->required();
  command->add_option("RUN", args->run, "*.mgtrun or a pose table in CSV")->required();
  args->flags = std::make_shared<FitFlags>();
  args->flags->places_needed = false;
  command
      ->add_option("--with", args->flags->with,
                   "effect of the site to allow for, by name; may be given again")
      ->allow_extra_args(false);
  add_field_flags(command, *args->flags);
  add_table_flag(command, *args->flags);
}

}  // namespace mgtd::daemon::cli
