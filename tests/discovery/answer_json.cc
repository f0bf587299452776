// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "tests/discovery/answer.h"

namespace mgtd::calib::testing {
namespace {

discovery::LawFinding finding_of(const std::string& name) {
  using enum discovery::LawFinding;
  for (const discovery::LawFinding finding : {pass, law, law_set, shape_only, noise_like, library})
    if (discovery::to_string(finding) == name) return finding;
  throw std::runtime_error("'" + name + "' is no finding");
}

}  // namespace

void to_json(nlohmann::json& j, const Answer& a) {
  j = {{"verdict", discovery::to_string(a.finding)},
       {"log10_p", a.log10_p},
       {"P", a.P},
       {"found", a.found},
       {"place", a.place},
       {"covariate", a.covariate},
       {"first", a.first},
       {"alike", a.alike},
       {"in_set", a.in_set},
       {"set", a.set},
       {"gain", a.gain ? nlohmann::json(*a.gain) : nlohmann::json(nullptr)},
       {"formula", a.formula},
       {"reason", a.reason},
       {"effects", a.effects}};
}

void from_json(const nlohmann::json& j, Answer& a) {
  a.finding = finding_of(j.at("verdict"));
  a.log10_p = j.at("log10_p"), a.P = j.at("P");
  a.found = j.at("found"), a.place = j.at("place"), a.covariate = j.at("covariate");
  a.first = j.at("first"), a.alike = j.at("alike"), a.in_set = j.at("in_set");
  a.set = j.at("set");
  a.gain.reset();
  if (const auto& gain = j.at("gain"); !gain.is_null()) a.gain = gain.get<double>();
  a.formula = j.at("formula"), a.reason = j.at("reason"), a.effects = j.at("effects");
}

}  // namespace mgtd::calib::testing
