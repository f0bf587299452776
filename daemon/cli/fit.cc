// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "calib/calibration/calibration.h"
#include "calib/report/fit_report_json.h"
#include "calib/report/fit_report_text.h"
#include "daemon/acquire/calibrated_with.h"
#include "daemon/cli/command.h"
#include "daemon/cli/fit_flags.h"
#include "daemon/cli/output_file.h"
#include "daemon/cli/work_progress.h"

namespace mgtd::daemon::cli {
namespace {

constexpr const char* kFitHelp =
    R"(What may be known about the field, alone or together:
  f_nT, or --field                   its size at every pose
  azimuth_deg, pitch_deg, roll_deg   angles of the table that turned the array
  ref_x_nT .. ref_z_nT, ref_sd_nT    the field as a vector. Without angles: in a frame fixed to the sensors (a coil
                                     cage). With angles: measured by a reference magnetometer that stands still
                                     beside the table, in axes of its own)";

struct FitArguments {
  std::string run, output;
  std::shared_ptr<FitFlags> flags;
};

int run_fit(const Session& session, const FitArguments& args) {
  const auto output = OutputFile::at(args.output, files_read(args.run, *args.flags));
  if (!output) return print_error(session, output.error());
  const auto source = read_source(args.run, *args.flags);
  if (!source) return print_error(session, source.error());
  const auto options = fit_options(*args.flags, *source);
  if (!options) return print_error(session, options.error());
  auto fitted = with_progress("fit", *options, [&](const calib::fit::FitOptions& told) {
    return calib::fit::method_choice::fit(source->table, told);
  });
  if (!fitted) return print_error(session, fitted.error());
  acquire::name_instruments(fitted->calibration, args.run);
  if (auto written = output->write(calib::calibration::to_json_text(fitted->calibration),
                                   "calibration " + fitted->calibration.id);
      !written)
    return print_error(session, written.error());
  if (session.json) {
    print_json(calib::report::to_json(*fitted));
  } else {
    print_text(session, calib::report::to_text(*fitted, table_width(session)));
  }
  return fitted->calibration.accepted_by_checks ? 0 : 1;
}

}  // namespace

void add_fit(CLI::App& app, Session& session) {
  auto args = std::make_shared<FitArguments>();
  CLI::App* const command = add_command(app, session, "fit", "calibrate from a run file or a pose table",
                                        [args, &session] { return run_fit(session, *args); });
  command->add_option("RUN", args->run, "*.mgtrun or a pose table in CSV")->required();
  command->add_option("-o,--output", args->output, "write the calibration here (CAL.json)");
  args->flags = add_fit_flags(command);
  command->add_flag(
      "--keep-all", args->flags->keep_all,
      "leave no reading out, whatever the others say of it: to compare with plain least squares");
  command->footer(kFitHelp);
}

}  // namespace mgtd::daemon::cli
