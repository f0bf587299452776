// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/scenario.h"

namespace mgtd::rig {
namespace {

nlohmann::json sensor_json(SensorTruth truth) {
  nlohmann::json out;
  for (const auto& [name, value] : named_parameters(truth)) out[name] = *value;
  out["mounting"] = mounting_text(truth.mounting);
  return out;
}

}  // namespace

nlohmann::json truth_json(const Scenario& s) {
  nlohmann::json sensors = nlohmann::json::array(), effects = nlohmann::json::array();
  for (const SensorTruth& truth : s.truth) sensors.push_back(sensor_json(truth));
  for (const auto& effect : s.effects) effects.push_back(effect->truth());
  return {{"schema", "mgt-rig.truth/1"},
          {"scenario", s.name},
          {"rig", s.rig},
          {"seed", s.seed},
          {"baseline_m", s.baseline_m},
          {"site",
           {{"f_nT", s.f_nT},
            {"inclination_deg", s.inclination_deg},
            {"declination_deg", s.declination_deg},
            {"drift_nT_per_h", s.field_drift_nT_per_h},
            {"diurnal_nT", s.diurnal_nT}}},
          {"noise_nT", s.noise_nT},
          {"noise", s.noise == NoiseKind::uniform ? "uniform" : "gaussian"},
          {"table_accuracy_deg", s.table_accuracy_deg},
          {"temperature",
           {{"start_degC", s.temperature.start_degC}, {"ramp_degC_per_h", s.temperature.ramp_degC_per_h}}},
          {"sensors", sensors},
          {"effects", effects}};
}

}  // namespace mgtd::rig
