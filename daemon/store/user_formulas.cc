// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/user_formulas.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "proto/json_text.h"

namespace mgtd::daemon::store {

using nlohmann::json;

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
                   {"confirmed_log10_p", or_null(d.confirmed_log10_p)}});
  }
  return out.dump(1);
}

Result<std::vector<Definition>> definitions_from_text(const std::string& text) {
  std::vector<Definition> out;
  constexpr const char* kRemedy = "read it with the version of mgt that wrote it";
  const auto list = parse_json_text(text, kRemedy);
  if (!list)
    return fail(ErrorCode::bad_input, "its formulas cannot be read: " + list.error().message, kRemedy);
  static const json kExample = json::parse(to_text({Definition{"", "", "", {{}}, {}}}));
  if (const auto wrong = misfit(kExample, *list))
    return fail(ErrorCode::bad_input, "its formulas cannot be read: " + wrong->text(text), kRemedy);
  try {
    for (const json& d : *list) {
      Definition one{d.at("name"), d.at("spec"), d.at("found_on"), {}, {}};
      for (const json& c : d.at("found"))
        one.found.push_back({c.at("name"), c.at("value"), c.at("sd"), c.at("unit")});
      if (const json& p = d.at("confirmed_log10_p"); !p.is_null()) one.confirmed_log10_p = p.get<double>();
      out.push_back(std::move(one));
    }
  } catch (const json::exception&) {
    return fail(ErrorCode::bad_input, "its formulas cannot be read: a p-value is not a number", kRemedy);
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
