// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/searched_model.h"

#include <fmt/format.h>

#include <algorithm>

#include "daemon/run/solver.h"
#include "proto/shell_word.h"

namespace mgtd::daemon::cli {
namespace {

bool holds(const std::vector<calib::effects::EffectPtr>& effects, const std::string& spec) {
  return std::any_of(effects.begin(), effects.end(),
                     [&](const calib::effects::EffectPtr& e) { return e->spec() == spec; });
}

}  // namespace

std::vector<std::string> commands_to_model(const std::vector<calib::effects::EffectPtr>& searched,
                                           const store::PoseSource& source, const std::string& run) {
  const auto kept = run::fit_options(source);
  if (!kept) return {};
  std::vector<std::string> out;
  const auto command = [&](const char* verb, const calib::effects::EffectPtr& effect) {
    out.push_back(fmt::format("mgt {} {} {}", verb, shell_word(effect->spec()), shell_word(run)));
  };
  for (const calib::effects::EffectPtr& effect : kept->effects)
    if (!holds(searched, effect->spec())) command("drop", effect);
  for (const calib::effects::EffectPtr& effect : searched)
    if (!holds(kept->effects, effect->spec())) command("add", effect);
  return out;
}

}  // namespace mgtd::daemon::cli
