// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/doubts.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "calib/report/choice_text.h"
#include "daemon/store/run_file.h"

namespace mgtd::cli {

using nlohmann::json;

Result<std::vector<daemon::ModelStep>> history_of(const std::string& run, const daemon::PoseSource& source) {
  if (!source.header) return std::vector<daemon::ModelStep>{};
  const auto file = daemon::RunFile::open(run, daemon::Access::read_only);
  if (!file) return tl::unexpected(file.error());
  return file->model_steps();
}

Result<std::vector<calib::Choice>> doubts_of(const std::string& run, const daemon::PoseSource& source,
                                             const calib::FitOptions& options) {
  const auto steps = history_of(run, source);
  if (!steps) return tl::unexpected(steps.error());
  std::vector<calib::Choice> out;
  for (const calib::EffectPtr& effect : options.effects) {
    const auto added = std::find_if(steps->rbegin(), steps->rend(), [&](const daemon::ModelStep& s) {
      return s.action == "add" && s.spec == effect->spec();
    });
    if (added == steps->rend()) continue;
    const json result = json::parse(added->result, nullptr, false);
    if (!result.is_object() || !result.contains("choice")) continue;
    calib::Choice choice = calib::choice_from_json(result["choice"]);
    if (!choice.open()) continue;
    choice = calib::on_these_poses(std::move(choice), source.table, options);
    if (choice.open()) out.push_back(std::move(choice));
  }
  return out;
}

std::string doubts_text(const std::vector<calib::Choice>& doubts) {
  std::string out;
  for (const calib::Choice& choice : doubts) out += calib::to_text(choice) + ".\n";
  return out;
}

json doubts_json(const std::vector<calib::Choice>& doubts) {
  json out = json::array();
  for (const calib::Choice& choice : doubts) {
    json one = calib::to_json(choice);
    one["text"] = calib::to_text(choice);
    out.push_back(std::move(one));
  }
  return out;
}

}  // namespace mgtd::cli
