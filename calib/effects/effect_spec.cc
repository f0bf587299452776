// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/effect_spec.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "proto/number.h"

namespace mgtd::calib::effects {

Result<EffectSpec> EffectSpec::parse(std::string_view text) {
  EffectSpec spec;
  std::string_view head = text.substr(0, text.find(','));
  std::string_view tail = text.substr(head.size());
  const auto at = head.find('@');
  spec.name = head.substr(0, at);
  if (at != std::string_view::npos) {
    const auto where = Where::parse(head.substr(at + 1));
    if (!where) return tl::unexpected(where.error());
    spec.where = *where;
  }
  while (!tail.empty()) {
    tail.remove_prefix(1);
    // An expression has commas of its own: it takes all text after it.
    const std::string_view part = tail.substr(0, tail.starts_with("expr=") ? tail.size() : tail.find(','));
    tail.remove_prefix(part.size());
    const auto equals = part.find('=');
    if (equals == 0 || equals == std::string_view::npos || equals + 1 == part.size()) {
      return fail(ErrorCode::usage, fmt::format("'{}' in '{}' is not PARAM=VALUE", part, text),
                  "write NAME[@WHERE][,PARAM=VALUE], for instance axis.hysteresis@s2,w=0.1");
    }
    spec.set(part.substr(0, equals), std::string(part.substr(equals + 1)));
  }
  return spec;
}

std::string EffectSpec::text() const {
  std::string out = name;
  if (where && where->scale != Where::Scale::own) out += "@" + where->text();
  const std::string* const expression = find("expr");
  for (const auto& [key, value] : parameters)
    if (&value != expression) out += "," + key + "=" + value;
  if (expression != nullptr) out += ",expr=" + *expression;
  return out;
}

const std::string* EffectSpec::find(std::string_view parameter) const {
  const auto found =
      std::find_if(parameters.begin(), parameters.end(), [&](const auto& p) { return p.first == parameter; });
  return found == parameters.end() ? nullptr : &found->second;
}

void EffectSpec::set(std::string_view parameter, double value) {
  set(parameter, fmt::format("{:.6g}", value));
}

void EffectSpec::set(std::string_view parameter, std::string value) {
  for (auto& [key, old] : parameters) {
    if (key != parameter) continue;
    old = std::move(value);
    return;
  }
  parameters.emplace_back(parameter, std::move(value));
}

Result<double> EffectSpec::number(std::string_view parameter, double otherwise, double lowest,
                                  double highest) const {
  const std::string* text = find(parameter);
  if (text == nullptr) return otherwise;
  const auto value = parse_number(*text);
  if (value && *value >= lowest && *value <= highest) return *value;
  return fail(
      ErrorCode::usage,
      fmt::format("{}: {}={} is no number from {:g} to {:g}", name, parameter, *text, lowest, highest),
      fmt::format("give {} in that range", parameter));
}

Result<void> EffectSpec::only(std::initializer_list<std::string_view> known) const {
  for (const auto& [key, value] : parameters) {
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    return fail(ErrorCode::usage, fmt::format("{} has no parameter '{}'", name, key),
                known.size() == 0 ? "leave it out" : fmt::format("it knows {}", fmt::join(known, ", ")));
  }
  return {};
}

std::string_view family_name(std::string_view spec) { return spec.substr(0, spec.find_first_of("@,")); }

}  // namespace mgtd::calib::effects
