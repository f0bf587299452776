// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "proto/error.h"
#include "proto/reading.h"

/// An OperatorPrompt is what a run asks its operator to do by hand; a scale entry is what the scale then
/// says. The target is a wish; what is entered is what is stored.
///
///   "prompt": {"what":"mount","pose":37,"mount":2,"target":{"azimuth_deg":0,"pitch_deg":0,"roll_deg":90},
///              "text":"..","again":".."}
///
/// `what`: "mount", the array on the table; "table", the scales of a table that is turned by hand; "note",
/// what `text` says is to be done before the pose, and answered with run.resume. `again` says why an entry is
/// asked for once more; null the first time.
namespace mgtd {

struct OperatorPrompt {
  enum class What { mount, table, note } what{What::table};
  int pose{0};
  std::optional<int> mount{};
  TableAngles target{};
  std::string text{}, again{};
};

[[nodiscard]] std::string_view name(OperatorPrompt::What what);
[[nodiscard]] nlohmann::ordered_json to_json(const OperatorPrompt& prompt);
[[nodiscard]] Result<OperatorPrompt> prompt_from_json(const nlohmann::json& object);

/// What the scales say. Where it names a pose or what was asked for, it answers no other prompt.
struct ScaleEntry {
  TableAngles angles;
  std::optional<int> pose{};
  std::optional<OperatorPrompt::What> what{};

  [[nodiscard]] bool answers(const OperatorPrompt& prompt) const {
    return pose.value_or(prompt.pose) == prompt.pose && what.value_or(prompt.what) == prompt.what;
  }
};

/// Arguments of run.enter: {"azimuth_deg":..,"pitch_deg":..,"roll_deg":..}, all three, each within 720 deg;
/// and, as the prompt has them, "pose" and "what".
[[nodiscard]] Result<ScaleEntry> parse_scale_entry(const nlohmann::json& args);
[[nodiscard]] nlohmann::json scale_entry_json(const TableAngles& angles);

}  // namespace mgtd
