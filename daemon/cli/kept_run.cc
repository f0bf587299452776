// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/kept_run.h"

#include <fmt/format.h>
#include <pwd.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <chrono>

#include "daemon/store/user_formulas.h"
#include "proto/run_status.h"
#include "proto/version.h"

namespace mgtd::daemon::cli {
namespace {

std::string this_user() {
  const passwd* const user = getpwuid(getuid());
  return user != nullptr ? user->pw_name : std::to_string(getuid());
}

WallTime now() {
  return {std::chrono::duration_cast<std::chrono::nanoseconds>(
              std::chrono::system_clock::now().time_since_epoch())
              .count()};
}

}  // namespace

Result<store::RunFile> open_to_keep(const std::string& path, const store::PoseSource& source) {
  if (!source.header) {
    return fail(
        ErrorCode::usage, path + " is a pose table, which keeps no model",
        fmt::format("make a run file of it (mgt import {} -o RUN.mgtrun), or use --with in each command",
                    path));
  }
  auto file = store::RunFile::open(path, store::Access::resume);
  if (!file) return file;
  const auto state = file->state();
  if (!state) return tl::unexpected(state.error());
  if (is_active(state->state)) {
    return fail(ErrorCode::state, fmt::format("{} is still being measured ({})", path, name(state->state)),
                "wait for its end, or end it: mgt run finish");
  }
  return file;
}

Result<KeptRun> open_kept_run(const std::string& path, const FitFlags& flags, Keeping keeping) {
  auto source = store::read_run(path);
  if (!source) return tl::unexpected(source.error());
  tell_masked(*source);
  if (keeping == Keeping::nothing) {
    auto options = fit_options(flags, *source);
    if (!options) return tl::unexpected(options.error());
    return KeptRun{std::nullopt, std::move(*source), std::move(*options), {}};
  }
  auto file = open_to_keep(path, *source);
  if (!file) return tl::unexpected(file.error());
  auto options = fit_options(flags, *source);
  if (!options) return tl::unexpected(options.error());
  return KeptRun{std::move(*file), std::move(*source), std::move(*options), {}};
}

void add_who_option(CLI::App* command, std::string& who) {
  command->add_option("--who", who, "who makes this step, where it is not the user")->group("");
}

Result<void> keep_step(KeptRun& run, const std::string& action, const std::string& spec,
                       const nlohmann::json& result) {
  const std::string who = fmt::format("{}, mgt {}", run.who.empty() ? this_user() : run.who, version());
  return run.file->append_model_step(
      {now(), who, action, spec, result.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)});
}

Result<void> keep_formula(store::RunFile& file, store::PoseSource& source,
                          const store::Definition& definition) {
  std::vector<store::Definition>& all = source.definitions;
  std::erase_if(all, [&](const store::Definition& d) { return d.name == definition.name; });
  all.push_back(definition);
  return file.set_document(store::kFormulasDocument, store::to_text(all));
}

std::string residual_change(const nlohmann::json& result, const std::string& arrow) {
  const auto residual = [&](const char* key) {
    const auto found = result.find(key);
    return found != result.end() && found->is_number() ? fmt::format("{:.3g}", found->get<double>())
                                                       : "refused";
  };
  const std::string before = residual("rms_before_nT"), after = residual("rms_after_nT");
  const bool fitted = after != "refused";
  if (!fitted && before == after) return "";
  return fmt::format("{}{} {} {}{}", before, fitted ? "" : " nT", arrow, after, fitted ? " nT" : "");
}

}  // namespace mgtd::daemon::cli
