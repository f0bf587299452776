// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/doubts.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "calib/report/choice_json.h"
#include "calib/report/choice_text.h"
#include "daemon/run/law_hypotheses.h"
#include "daemon/store/run_file.h"

namespace mgtd::daemon::cli {

using nlohmann::json;

Result<std::vector<store::ModelStep>> history_of(const std::string& run, const store::PoseSource& source) {
  if (!source.header) return std::vector<store::ModelStep>{};
  const auto file = store::RunFile::open(run, store::Access::read_only);
  if (!file) return tl::unexpected(file.error());
  return file->model_steps();
}

calib::criticism::search::Choice choice_by_discovery(const store::PoseSource& source,
                                                     const calib::effects::Effect& effect,
                                                     const calib::fit::FitOptions& options) {
  const auto definition = std::find_if(source.definitions.begin(), source.definitions.end(),
                                       [&](const store::Definition& d) { return d.spec == effect.spec(); });
  if (definition == source.definitions.end() || !definition->discovered) return {};
  const store::Discovered& discovered = *definition->discovered;
  calib::criticism::search::Choice out{
      .spec = effect.spec(), .finding = discovered.word, .alternatives = {}, .data = discovered.data_hash};
  for (const store::Discovered::Other& other : discovered.others)
    if (!other.spec.empty() && out.alternatives.size() + 1 < run::kMostHypotheses)
      out.alternatives.push_back(other.spec);
  return calib::criticism::search::on_these_poses(std::move(out), source.table, options);
}

Result<std::vector<calib::criticism::search::Choice>> doubts_of(const std::string& run,
                                                                const store::PoseSource& source,
                                                                const calib::fit::FitOptions& options) {
  const auto steps = history_of(run, source);
  if (!steps) return tl::unexpected(steps.error());
  std::vector<calib::criticism::search::Choice> out;
  for (const calib::effects::EffectPtr& effect : options.effects) {
    const auto added = std::find_if(steps->rbegin(), steps->rend(), [&](const store::ModelStep& s) {
      return s.action == "add" && s.spec == effect->spec();
    });
    if (added == steps->rend()) continue;
    const json result = json::parse(added->result, nullptr, false);
    if (!result.is_object() || !result.contains("choice")) continue;
    calib::criticism::search::Choice choice = calib::report::choice_from_json(result["choice"]);
    if (!choice.open()) continue;
    choice = calib::criticism::search::on_these_poses(std::move(choice), source.table, options);
    if (choice.open()) out.push_back(std::move(choice));
  }
  return out;
}

std::string doubts_text(const std::vector<calib::criticism::search::Choice>& doubts) {
  std::string out;
  for (const calib::criticism::search::Choice& choice : doubts) out += calib::report::to_text(choice) + ".\n";
  return out;
}

json doubts_json(const std::vector<calib::criticism::search::Choice>& doubts) {
  json out = json::array();
  for (const calib::criticism::search::Choice& choice : doubts) {
    json one = calib::report::to_json(choice);
    one["text"] = calib::report::to_text(choice);
    out.push_back(std::move(one));
  }
  return out;
}

}  // namespace mgtd::daemon::cli
