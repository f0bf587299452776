// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/model_history.h"

#include <map>
#include <nlohmann/json.hpp>

#include "daemon/store/pose_numbers.h"

namespace mgtd::daemon::store {
namespace {

struct Stage {
  std::vector<std::string> model;
  std::map<int, const ModelStep*> masked;  ///< by number: the step that masked it
  const ModelStep* by{nullptr};
};

void change_mask(const ModelStep& step, Stage& stage) {
  const auto numbers = parse_pose_numbers(step.spec);
  if (!numbers) return;
  for (const int number : *numbers) {
    if (step.action == "mask") {
      stage.masked.emplace(number, &step);
    } else {
      stage.masked.erase(number);
    }
  }
}

std::string reason_of(const ModelStep& step) {
  const nlohmann::json result = nlohmann::json::parse(step.result, nullptr, false);
  if (!result.is_object() || !result.contains("because") || !result["because"].is_string()) return {};
  return result["because"].get<std::string>();
}

/// Every model that an undo can go back to, the present one last.
std::vector<Stage> stages(std::span<const ModelStep> steps) {
  std::vector<Stage> out(1);
  for (const ModelStep& step : steps) {
    if (step.action == "undo") {
      if (out.size() > 1) out.pop_back();
      continue;
    }
    Stage next{out.back().model, out.back().masked, &step};
    if (step.action == "add") next.model.push_back(step.spec);
    if (step.action == "drop") std::erase(next.model, step.spec);
    if (step.action == "mask" || step.action == "unmask") change_mask(step, next);
    out.push_back(std::move(next));
  }
  return out;
}

}  // namespace

std::vector<std::string> current_model(std::span<const ModelStep> steps) {
  return stages(steps).back().model;
}

std::vector<MaskedPose> masked_poses(std::span<const ModelStep> steps) {
  std::vector<MaskedPose> out;
  const Stage last = stages(steps).back();
  for (const auto& [number, step] : last.masked)
    out.push_back({.number = number, .because = reason_of(*step), .who = step->who, .at = step->at});
  return out;
}

std::optional<ModelStep> undoable(std::span<const ModelStep> steps) {
  const Stage last = stages(steps).back();
  return last.by == nullptr ? std::nullopt : std::optional(*last.by);
}

}  // namespace mgtd::daemon::store
