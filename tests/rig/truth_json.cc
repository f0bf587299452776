// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "tests/rig/scenario.h"

namespace mgtd::rig {
namespace {

const char* name_of(NoiseKind kind) {
  return kind == NoiseKind::uniform ? "uniform" : kind == NoiseKind::student ? "student" : "gaussian";
}

nlohmann::json covariate_json(const Covariate& c) {
  nlohmann::json out{{"name", c.name},
                     {"mean", c.mean},
                     {"amplitude", c.amplitude},
                     {"wave", c.wave == Wave::toggle ? "toggle"
                              : c.wave == Wave::sine ? "sine"
                                                     : "ramp"},
                     {"every_s", c.every_s},
                     {"recorded", c.recorded}};
  if (c.input)
    out["input"] = {{"of", fmt::format("s{}.{}", c.input->slot + 1, c.input->letter)},
                    {"unit", c.input->unit},
                    {"per_V", c.input->per_V},
                    {"at_0V", c.input->at_0V}};
  return out;
}

nlohmann::json vehicle_json(const Vehicle& v) {
  return {{"at_s", v.at_s},
          {"nearest_m", v.nearest_m},
          {"speed_m_per_s", v.speed_m_per_s},
          {"stands_s", v.stands_s},
          {"moment_Am2", v.moment_Am2}};
}

nlohmann::json magnet_json(const DroppedMagnet& m) {
  nlohmann::json out{{"at_s", m.at_s}, {"moment_Am2", m.moment_Am2}, {"at_m", m.at_m}};
  if (std::isfinite(m.until_s)) out["until_s"] = m.until_s;
  return out;
}

nlohmann::json gross_json(const GrossReading& g) {
  nlohmann::json out{{"pose", g.pose}, {"poses", g.poses}, {"where", g.where.text()}};
  out["do"] = g.kind == Gross::off ? "off" : g.kind == Gross::stuck ? "stuck" : "saturated";
  if (g.kind == Gross::off) out["nT"] = g.nT;
  return out;
}

template <class Items, class ToJson>
nlohmann::json list(const Items& items, ToJson to_json) {
  nlohmann::json out = nlohmann::json::array();
  for (const auto& item : items) out.push_back(to_json(item));
  return out;
}

nlohmann::json sensor_json(SensorTruth truth) {
  nlohmann::json out;
  for (const auto& [name, value] : named_parameters(truth)) out[name] = *value;
  out["mounting"] = mounting_text(truth.mounting);
  return out;
}

}  // namespace

nlohmann::json truth_json(const Scenario& s) {
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
          {"clocks",
           {{"oscillator_ppm", s.oscillator_ppm},
            {"rate_error_percent", s.rate_error_percent},
            {"delivery_s", s.delivery_s},
            {"delivery_ppm", s.delivery_ppm}}},
          {"noise_nT", s.noise.noise_nT},
          {"noise", name_of(s.noise.kind)},
          {"more_noise",
           {{"ar1_rho", s.noise.ar1_rho},
            {"slow_nT", s.noise.slow_nT},
            {"slow_tau_s", s.noise.slow_tau_s},
            {"walk_nT_per_sqrt_h", s.noise.walk_nT_per_sqrt_h},
            {"flicker_nT_per_sqrt_hz", s.noise.flicker_nT_per_sqrt_hz},
            {"mean_step_nT", s.noise.mean_step_nT},
            {"spike_share", s.noise.spike_share},
            {"spike_nT", s.noise.spike_nT},
            {"lsb_nT", s.noise.lsb_nT}}},
          {"visit",
           {{"noise", name_of(s.visit.kind)},
            {"noise_nT", s.visit.noise_nT},
            {"rho", s.visit.rho},
            {"outlier_share", s.visit.outlier_share},
            {"outlier_nT", s.visit.outlier_nT},
            {"cycle_nT", s.visit.cycle_nT},
            {"cycle_visits", s.visit.cycle_visits},
            {"cycle_where", s.visit.cycle_where.text()}}},
          {"wiring", s.wiring},
          {"plugs", s.plugs},
          {"tells_serial", s.tells_serial},
          {"copied", s.copied},
          {"apart", s.apart},
          {"table_accuracy_deg", s.table_accuracy_deg},
          {"temperature",
           {{"start_degC", s.temperature.start_degC}, {"ramp_degC_per_h", s.temperature.ramp_degC_per_h}}},
          {"sensors", list(s.truth, &sensor_json)},
          {"covariates", list(s.covariates, &covariate_json)},
          {"effects", list(s.effects, [](const auto& effect) { return effect->truth(); })},
          {"vehicles", list(s.vehicles, &vehicle_json)},
          {"magnets", list(s.magnets, &magnet_json)},
          {"faults", list(s.faults,
                          [](const TimedFault& f) {
                            return nlohmann::json{{"at_s", f.at_s}, {"do", f.text}};
                          })},
          {"gross", list(s.gross, &gross_json)}};
}

}  // namespace mgtd::rig
