// SPDX-License-Identifier: Apache-2.0
#include "calib/report/choice_json.h"

#include <nlohmann/json.hpp>

namespace mgtd::calib::report {

using nlohmann::json;

json to_json(const criticism::search::Choice& choice) {
  return {{"spec", choice.spec},
          {"finding", choice.finding},
          {"rivals", choice.alternatives},
          {"describes_only", choice.describes},
          {"data", choice.data}};
}

criticism::search::Choice choice_from_json(const json& object) {
  try {
    return {.spec = object.at("spec"),
            .finding = object.at("finding"),
            .alternatives = object.at("rivals"),
            .describes = object.at("describes_only"),
            .data = object.at("data")};
  } catch (const json::exception&) {
    return {};
  }
}

}  // namespace mgtd::calib::report
