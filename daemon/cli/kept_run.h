// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "daemon/cli/fit_flags.h"
#include "daemon/store/run_file.h"

/// A KeptRun is a run file whose model an operator works on: what was measured, the model as it is kept, and
/// the way to write the next step. Refuses a pose table, which keeps nothing, and a run that is still being
/// measured.
namespace mgtd::daemon::cli {

struct KeptRun {
  std::optional<store::RunFile> file;  ///< empty: nothing is kept
  store::PoseSource source;
  calib::fit::FitOptions options;  ///< with the kept model
  std::string who{};               ///< makes the steps; empty: the user of this process
};

/// Whether a command leaves a step behind, or only tries it: then a pose table will do, and a run that is
/// still being measured.
enum class Keeping { steps, nothing };

/// The file that `source` was read from, to keep something in it. Refuses what KeptRun refuses.
[[nodiscard]] Result<store::RunFile> open_to_keep(const std::string& path, const store::PoseSource& source);

[[nodiscard]] Result<KeptRun> open_kept_run(const std::string& path, const FitFlags& flags,
                                            Keeping keeping = Keeping::steps);

/// --who: whoever this process works for where its user is another, as the console's jobs are. Not in the
/// help.
void add_who_option(CLI::App* command, std::string& who);

/// The next step, by `run.who` with this version, now.
[[nodiscard]] Result<void> keep_step(KeptRun& run, const std::string& action, const std::string& spec,
                                     const nlohmann::json& result);

/// Keeps a user's formula in the file and in `source`; one of the same name gives way.
[[nodiscard]] Result<void> keep_formula(store::RunFile& file, store::PoseSource& source,
                                        const store::Definition& definition);

/// "0.0911 -> 0.0809 nT" of the result of a step, "0.0911 nT -> refused" where the fit after it is refused;
/// empty where the step tells no residual.
[[nodiscard]] std::string residual_change(const nlohmann::json& result, const std::string& arrow);

}  // namespace mgtd::daemon::cli
