// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/user_formulas.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "proto/json_text.h"

namespace mgtd::daemon::store {

using nlohmann::json;

namespace {

constexpr const char* kRemedy = "read it with the version of mgt that wrote it";

json to_json(const Discovered& d) {
  json others = json::array();
  for (const Discovered::Other& other : d.others)
    others.push_back(
        {{"formula", other.formula}, {"where", other.where}, {"P", other.P}, {"spec", other.spec}});
  return {{"word", d.word},
          {"P", d.P},
          {"others", std::move(others)},
          {"more", d.more},
          {"data_hash", d.data_hash}};
}

/// Null, or no key in files of earlier versions: nothing was discovered.
std::optional<Discovered> discovered_from(const json& definition) {
  const auto found = definition.find("discovered");
  if (found == definition.end() || found->is_null()) return std::nullopt;
  Discovered out{.word = found->at("word"),
                 .P = found->at("P"),
                 .others = {},
                 .more = found->at("more"),
                 .data_hash = found->at("data_hash")};
  for (const json& other : found->at("others"))
    out.others.push_back({other.at("formula"), other.at("where"), other.at("P"), other.at("spec")});
  return out;
}

}  // namespace

std::string Discovered::text() const {
  constexpr std::size_t kShown = 3;
  std::string out = fmt::format("found by mgt discover ({}, P {:.2f})", word, P);
  if (others.empty() && more == 0) return out;
  std::vector<std::string> shown;
  for (std::size_t i = 0; i < std::min(kShown, others.size()); ++i)
    shown.push_back(fmt::format("{} at {} ({:.2f})", others[i].formula, others[i].where, others[i].P));
  const std::size_t left = others.size() - shown.size() + more;
  if (left > 0) shown.push_back(fmt::format("{} more", left));
  return out + fmt::format("; could also be {}", fmt::join(shown, ", "));
}

std::string to_text(const std::vector<Definition>& definitions) {
  json out = json::array();
  for (const Definition& d : definitions) {
    json found = json::array();
    for (const calib::calibration::EffectCoefficient& c : d.found)
      found.push_back({{"name", c.name}, {"value", c.value}, {"sd", c.sd}, {"unit", c.unit}});
    out.push_back({{"name", d.name},
                   {"spec", d.spec},
                   {"found_on", d.found_on},
                   {"found", std::move(found)},
                   {"confirmed_log10_p", or_null(d.confirmed_log10_p)},
                   {"discovered", d.discovered ? to_json(*d.discovered) : json()}});
  }
  return out.dump(1);
}

Result<std::vector<Definition>> definitions_from_text(const std::string& text) {
  std::vector<Definition> out;
  const auto list = parse_json_text(text, kRemedy);
  if (!list)
    return fail(ErrorCode::bad_input, "its formulas cannot be read: " + list.error().message, kRemedy);
  static const json kExample = [] {
    json example = json::parse(to_text({Definition{"", "", "", {{}}, {}}}));
    example.at(0).erase("discovered");  // earlier versions did not write it
    return example;
  }();
  if (const auto wrong = misfit(kExample, *list))
    return fail(ErrorCode::bad_input, "its formulas cannot be read: " + wrong->text(text), kRemedy);
  try {
    for (const json& d : *list) {
      Definition one{d.at("name"), d.at("spec"), d.at("found_on"), {}, {}, discovered_from(d)};
      for (const json& c : d.at("found"))
        one.found.push_back({c.at("name"), c.at("value"), c.at("sd"), c.at("unit")});
      if (const json& p = d.at("confirmed_log10_p"); !p.is_null()) one.confirmed_log10_p = p.get<double>();
      out.push_back(std::move(one));
    }
  } catch (const json::exception&) {
    return fail(ErrorCode::bad_input, "its formulas cannot be read: a number or a text is of another kind",
                kRemedy);
  }
  return out;
}

std::string whole_spec(const std::string& text, const std::vector<Definition>& definitions) {
  const auto known = std::find_if(definitions.begin(), definitions.end(), [&](const Definition& d) {
    return d.name == calib::effects::family_name(text);
  });
  const auto asked = calib::effects::EffectSpec::parse(text);
  if (known == definitions.end() || !asked || asked->find("expr") != nullptr) return text;
  auto spec = calib::effects::EffectSpec::parse(known->spec);
  if (!spec) return text;
  if (asked->where) spec->where = asked->where;
  for (const auto& [key, value] : asked->parameters) spec->set(key, value);
  return spec->text();
}

}  // namespace mgtd::daemon::store
