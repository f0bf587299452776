// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "tests/rig/scenario.h"

/// In the blind game a rig hides something, the answer is sealed, and its hash is printed before the guess,
/// so that nobody can change it afterwards.
namespace mgtd::rig {

struct Seal {
  std::string sha256;   ///< of the truth, a number drawn for the occasion included
  std::string content;  ///< of the sealed file: not readable at a glance, no secret from a debugger
};

[[nodiscard]] Seal seal(const nlohmann::json& truth, std::mt19937_64& random);
/// The truth; refuses a file whose hash is not that of what lies in it.
[[nodiscard]] tl::expected<nlohmann::json, std::string> open_seal(std::string_view content);

/// The same rig with so many effects more, drawn at random at sizes worth finding, none of those that no run
/// can show. The heads warm up, a motor is switched and a battery runs down, whether or not it matters.
[[nodiscard]] Scenario with_hidden(Scenario scenario, int effects, std::mt19937_64& random);

}  // namespace mgtd::rig
