// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "proto/time.h"

/// The history of a model lists the effects that an operator put in and took out on a run, step by step. The
/// steps are never changed; the model is what they lead to.
namespace mgtd::daemon::store {

struct ModelStep {
  WallTime at;
  std::string who;     ///< user and software
  std::string action;  ///< "add", "drop", "undo"
  std::string spec;    ///< of the effect; of an undo, that of the step it takes back
  std::string result;  ///< JSON: what it did to the error
};

/// Specs, in the order they were put in.
[[nodiscard]] std::vector<std::string> kept_model(std::span<const ModelStep> steps);
/// The step that an undo would take back; empty when none is left.
[[nodiscard]] std::optional<ModelStep> undoable(std::span<const ModelStep> steps);

}  // namespace mgtd::daemon::store
