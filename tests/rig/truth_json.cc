// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/scenario.h"

namespace mgtd::rig {
namespace {

const char* name_of(NoiseKind kind) {
  return kind == NoiseKind::uniform ? "uniform" : kind == NoiseKind::student ? "student" : "gaussian";
}

nlohmann::json covariate_json(const Covariate& c) {
  return {{"name", c.name},
          {"mean", c.mean},
          {"amplitude", c.amplitude},
          {"wave", c.wave == Wave::toggle ? "toggle"
                   : c.wave == Wave::sine ? "sine"
                                          : "ramp"},
          {"every_s", c.every_s},
          {"recorded", c.recorded}};
}

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
  nlohmann::json covariates = nlohmann::json::array();
  for (const Covariate& c : s.covariates) covariates.push_back(covariate_json(c));
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
          {"noise_nT", s.noise.noise_nT},
          {"noise", name_of(s.noise.kind)},
          {"more_noise",
           {{"ar1_rho", s.noise.ar1_rho},
            {"slow_nT", s.noise.slow_nT},
            {"slow_tau_s", s.noise.slow_tau_s},
            {"spike_share", s.noise.spike_share},
            {"spike_nT", s.noise.spike_nT},
            {"lsb_nT", s.noise.lsb_nT}}},
          {"visit",
           {{"noise", name_of(s.visit.kind)},
            {"noise_nT", s.visit.noise_nT},
            {"rho", s.visit.rho},
            {"outlier_share", s.visit.outlier_share},
            {"outlier_nT", s.visit.outlier_nT}}},
          {"wiring", s.wiring},
          {"table_accuracy_deg", s.table_accuracy_deg},
          {"temperature",
           {{"start_degC", s.temperature.start_degC}, {"ramp_degC_per_h", s.temperature.ramp_degC_per_h}}},
          {"sensors", sensors},
          {"covariates", covariates},
          {"effects", effects}};
}

}  // namespace mgtd::rig
