// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/model_history.h"

namespace mgtd::daemon::store {
namespace {

struct Stage {
  std::vector<std::string> model;
  const ModelStep* by{nullptr};
};

/// Every model that an undo can go back to, the present one last.
std::vector<Stage> stages(std::span<const ModelStep> steps) {
  std::vector<Stage> out(1);
  for (const ModelStep& step : steps) {
    if (step.action == "undo") {
      if (out.size() > 1) out.pop_back();
      continue;
    }
    Stage next{out.back().model, &step};
    if (step.action == "add") next.model.push_back(step.spec);
    if (step.action == "drop") std::erase(next.model, step.spec);
    out.push_back(std::move(next));
  }
  return out;
}

}  // namespace

std::vector<std::string> kept_model(std::span<const ModelStep> steps) { return stages(steps).back().model; }

std::optional<ModelStep> undoable(std::span<const ModelStep> steps) {
  const Stage last = stages(steps).back();
  return last.by == nullptr ? std::nullopt : std::optional(*last.by);
}

}  // namespace mgtd::daemon::store
