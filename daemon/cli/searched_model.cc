// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/searched_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "daemon/run/solver.h"
#include "proto/shell_word.h"

namespace mgtd::daemon::cli {
namespace {

bool holds(const std::vector<calib::effects::EffectPtr>& effects, const std::string& spec) {
  return std::any_of(effects.begin(), effects.end(),
                     [&](const calib::effects::EffectPtr& e) { return e->spec() == spec; });
}

}  // namespace

calib::report::CommandsToModel commands_to_model(const std::vector<calib::effects::EffectPtr>& searched,
                                                 const store::PoseSource& source, const std::string& run) {
  const auto kept = run::fit_options(source);
  if (!kept) return {};
  calib::report::CommandsToModel out{.run = run, .commands = {}};
  if (!source.header) {
    out.run = std::filesystem::path(run).replace_extension(".mgtrun").string();
    out.commands.push_back(fmt::format("mgt import {} -o {}", shell_word(run), shell_word(out.run)));
  }
  const auto command = [&](const char* verb, const calib::effects::EffectPtr& effect) {
    out.commands.push_back(
        fmt::format("mgt {} {} {}", verb, shell_word(effect->spec()), shell_word(out.run)));
  };
  for (const calib::effects::EffectPtr& effect : kept->effects)
    if (!holds(searched, effect->spec())) command("drop", effect);
  for (const calib::effects::EffectPtr& effect : searched)
    if (!holds(kept->effects, effect->spec())) command("add", effect);
  return out;
}

}  // namespace mgtd::daemon::cli
