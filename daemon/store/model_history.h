// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "proto/time.h"

/// The history of a model lists the effects that an operator put in and took out on a run, and the poses that
/// were masked, step by step. The steps are never changed; model and mask are what they lead to.
namespace mgtd::daemon::store {

struct ModelStep {
  WallTime at;
  std::string who;     ///< user and software
  std::string action;  ///< "add", "drop", "mask", "unmask", "undo"
  std::string spec;    ///< of the effect, or the poses; of an undo, that of the step it takes back
  std::string result;  ///< JSON: what it did to the error; of a mask also "because"
};

/// A pose that every computation leaves out because an operator said so.
struct MaskedPose {
  int number{0};
  std::string because{}, who{};
  WallTime at{};
};

/// Specs, in the order they were put in.
[[nodiscard]] std::vector<std::string> current_model(std::span<const ModelStep> steps);
/// By number.
[[nodiscard]] std::vector<MaskedPose> masked_poses(std::span<const ModelStep> steps);
/// The step that an undo would take back; empty when none is left.
[[nodiscard]] std::optional<ModelStep> undoable(std::span<const ModelStep> steps);

}  // namespace mgtd::daemon::store
