// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/effect_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace mgtd::rig {
namespace {

const EffectKind* kind_named(const std::string& name) {
  const auto kinds = all_kinds();
  const auto found =
      std::find_if(kinds.begin(), kinds.end(), [&](const EffectKind* k) { return name == k->name; });
  return found == kinds.end() ? nullptr : *found;
}

std::string names() {
  std::string out;
  for (const EffectKind* kind : all_kinds()) out += (out.empty() ? "" : ", ") + std::string(kind->name);
  return out;
}

std::string random_where(Scope scope, std::mt19937_64& random, std::size_t sensors) {
  std::uniform_int_distribution<int> sensor(1, static_cast<int>(sensors)), axis(0, 2);
  std::string out = fmt::format("s{}", sensor(random));
  if (scope == Scope::axis) out += fmt::format(".{}", "xyz"[axis(random)]);
  return out;
}

/// A direction at random, as long as the typical size wants it.
std::string random_value(const Key& key, double size, std::mt19937_64& random) {
  std::uniform_real_distribution<double> between(key.low, key.high);
  std::normal_distribution<double> normal;
  const auto count = static_cast<std::size_t>(key.count);
  std::vector<double> values(count);
  double norm = 0;
  for (double& v : values) {
    v = normal(random);
    norm += v * v;
  }
  for (double& v : values) {
    // Places keep their distance from the array, on a side of chance; times and widths are as they are drawn.
    const double drawn = key.low < key.high ? between(random) : 0;
    v = key.low == key.high ? v * key.typical * size / std::sqrt(norm)
                            : drawn * (count == 1 ? 1 : v / std::sqrt(norm));
  }
  if (key.low < key.high && count == 1 && key.low == std::floor(key.low) && key.high > 1000)
    values[0] = std::floor(values[0]);
  if (count == 1) return fmt::format("{}", values[0]);
  return fmt::format("[{}]", fmt::join(values, ", "));
}

}  // namespace

std::shared_ptr<const Effect> read_effect(Section& s) {
  std::string name, of;
  s.read("name", name);
  const EffectKind* const kind = kind_named(name);
  if (kind == nullptr) {
    s.complain("name", fmt::format("no effect '{}'; there are: {}", name, names()));
    s.accept_rest();
    return nullptr;
  }
  const Where where = kind->scope == Scope::none ? Where{} : s.where();
  if (kind->scope == Scope::sensor && where.one_axis())
    s.complain("where", fmt::format("{} acts on a whole sensor: all or s1 .. s{}", name, s.sensors()));
  if (kind->needs_covariate) {
    s.read("of", of);
    if (of.empty()) s.complain("", "of is missing: the name of a [[covariate]]");
  }
  Numbers numbers;
  for (const Key& key : kind->keys) {
    if (key.name == nullptr) break;
    const auto values = s.numbers(key.name, static_cast<std::size_t>(key.count), key.fallback);
    numbers.value.insert(numbers.value.end(), values.begin(), values.end());
  }
  return make_effect(*kind, where, std::move(numbers), of);
}

tl::expected<std::shared_ptr<const Effect>, std::string> effect_of(std::string_view toml,
                                                                   std::size_t sensors) {
  try {
    const toml::table table = toml::parse(toml);
    std::vector<Mistake> mistakes;
    Section section(&table, "effect", mistakes, sensors);
    auto effect = read_effect(section);
    section.refuse_rest();
    if (!mistakes.empty()) return tl::unexpected(mistakes.front().text);
    return effect;
  } catch (const toml::parse_error& error) {
    return tl::unexpected(std::string(error.description()));
  }
}

std::string random_effect(const EffectKind& kind, double size, std::mt19937_64& random, std::string_view of,
                          std::size_t sensors) {
  std::string out = fmt::format("name = \"{}\"\n", kind.name);
  if (kind.scope != Scope::none)
    out += fmt::format("where = \"{}\"\n", random_where(kind.scope, random, sensors));
  if (kind.needs_covariate) out += fmt::format("of = \"{}\"\n", of);
  for (const Key& key : kind.keys) {
    if (key.name == nullptr) break;
    if (!std::isnan(key.fallback) && key.low == key.high) continue;
    out += fmt::format("{} = {}\n", key.name, random_value(key, size, random));
  }
  return out;
}

std::vector<std::string> effect_help() {
  std::vector<std::string> out;
  for (const EffectKind* kind : all_kinds()) {
    std::string line = fmt::format("{:31}", kind->name);
    if (kind->scope != Scope::none) line += " where";
    if (kind->needs_covariate) line += " of";
    for (const Key& key : kind->keys) {
      if (key.name == nullptr) break;
      line += fmt::format(" {}", key.name);
      if (key.count > 1) line += fmt::format("[{}]", key.count);
    }
    out.push_back(std::move(line));
  }
  return out;
}

}  // namespace mgtd::rig
