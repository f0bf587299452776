// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "tests/blind/real_answer.h"

namespace mgtd::calib::testing {
namespace {

using Json = nlohmann::json;

constexpr std::array kFindings{criticism::search::Finding::pass,      criticism::search::Finding::explained,
                               criticism::search::Finding::ambiguous, criticism::search::Finding::partial,
                               criticism::search::Finding::unknown,   criticism::search::Finding::bad_data};

Json number(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }
std::optional<double> number(const Json& value) {
  return value.is_null() ? std::nullopt : std::optional(value.get<double>());
}

criticism::search::Finding finding(const std::string& name) {
  for (const criticism::search::Finding f : kFindings)
    if (to_string(f) == name) return f;
  throw std::runtime_error("'" + name + "' is no verdict");
}

}  // namespace

void to_json(Json& j, const RealAnswer& a) {
  j = {{"fit_refused", a.fit_refused},
       {"explain_refused", a.explain_refused},
       {"accepted", a.accepted},
       {"finding", to_string(a.finding)},
       {"left_out", a.left_out},
       {"named", a.named},
       {"declared", a.declared},
       {"error_nT_per_m", number(a.error_nT_per_m)},
       {"error_after_nT_per_m", number(a.error_after_nT_per_m)},
       {"plain_nT_per_m", number(a.plain_nT_per_m)},
       {"nees_scales", number(a.nees_scales)},
       {"nees_offsets", number(a.nees_offsets)},
       {"cpu_s", a.cpu_s}};
}

void from_json(const Json& j, RealAnswer& a) {
  a.fit_refused = j.at("fit_refused");
  a.explain_refused = j.at("explain_refused");
  a.accepted = j.at("accepted");
  a.finding = finding(j.at("finding"));
  a.left_out = j.at("left_out");
  a.named = j.at("named");
  a.declared = j.at("declared");
  a.error_nT_per_m = number(j.at("error_nT_per_m"));
  a.error_after_nT_per_m = number(j.at("error_after_nT_per_m"));
  a.plain_nT_per_m = number(j.at("plain_nT_per_m"));
  a.nees_scales = number(j.at("nees_scales"));
  a.nees_offsets = number(j.at("nees_offsets"));
  a.cpu_s = j.at("cpu_s");
}

}  // namespace mgtd::calib::testing
