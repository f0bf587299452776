// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/seal.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "proto/sha256.h"
#include "tests/rig/effect_list.h"

namespace mgtd::rig {
namespace {

constexpr std::string_view kSchema = "mgt-rig.sealed/1";
/// What no run of the default kind can show.
constexpr std::array<std::string_view, 4> kInvisible{"platform.hard-iron", "platform.soft-iron",
                                                     "platform.crosstalk", "platform.tabletop-magnet"};

std::string to_hex(std::string_view text) {
  std::string out;
  for (const char c : text) out += fmt::format("{:02x}", static_cast<unsigned char>(c));
  return out;
}

std::string bytes_of_hex(std::string_view hex) {
  std::string out;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
    unsigned value = 0;
    std::from_chars(hex.data() + i, hex.data() + i + 2, value, 16);
    out += static_cast<char>(value);
  }
  return out;
}

}  // namespace

Seal seal(const nlohmann::json& truth, std::mt19937_64& random) {
  nlohmann::json inside = truth;
  inside["drawn"] = fmt::format("{:016x}{:016x}", random(), random());  // so that no guess can be tried
  const std::string text = inside.dump();
  const std::string hash = sha256_hex(text);
  const nlohmann::json out{{"schema", kSchema}, {"sha256", hash}, {"sealed", to_hex(text)}};
  return {hash, out.dump(1) + "\n"};
}

tl::expected<nlohmann::json, std::string> open_seal(std::string_view content) {
  const auto file = nlohmann::json::parse(content, nullptr, false);
  if (!file.is_object() || file.value("schema", "") != kSchema || !file.contains("sealed") ||
      !file["sealed"].is_string())
    return tl::unexpected(std::string("this is no sealed truth of mgt-rig"));
  const std::string text = bytes_of_hex(file["sealed"].get<std::string>());
  const std::string told = file.value("sha256", ""), found = sha256_hex(text);
  if (told != found)
    return tl::unexpected(
        fmt::format("the seal is broken: its hash says {}, what lies in it {}", told, found));
  auto truth = nlohmann::json::parse(text, nullptr, false);
  if (truth.is_discarded()) return tl::unexpected(std::string("what lies in it is no truth"));
  return truth;
}

Scenario with_hidden(Scenario scenario, int effects, std::mt19937_64& random) {
  if (scenario.temperature.ramp_degC_per_h == 0) {
    scenario.temperature.start_degC = 18.5;
    scenario.temperature.ramp_degC_per_h = 5;
    scenario.temperature.head_degC = {0.0, 0.4, -0.3, 0.2};  // any further one: none
  }
  scenario.covariates.push_back({.name = "motor_A", .mean = 1, .amplitude = 1, .pattern = random() % 1000});
  scenario.covariates.push_back(
      {.name = "battery_V", .mean = 12.6, .amplitude = -0.9, .wave = Wave::ramp, .every_s = 3600});
  auto kinds = all_kinds();
  std::erase_if(kinds, [](const EffectKind* kind) {
    return std::find(kInvisible.begin(), kInvisible.end(), kind->name) != kInvisible.end();
  });
  std::shuffle(kinds.begin(), kinds.end(), random);
  std::uniform_real_distribution<double> log_size(std::log(0.7), std::log(3.0));
  for (int k = 0; k < effects && k < static_cast<int>(kinds.size()); ++k) {
    const EffectKind& kind = *kinds[static_cast<std::size_t>(k)];
    const std::string of = kind.unnamed ? "battery_V" : "motor_A";
    const auto effect = effect_of(
        random_effect(kind, std::exp(log_size(random)), random, of, scenario.sensors()), scenario.sensors());
    if (effect) scenario.effects.push_back(*effect);
  }
  return scenario;
}

}  // namespace mgtd::rig
