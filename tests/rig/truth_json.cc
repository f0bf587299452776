// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

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

/// One for each sensor, whether or not the scenario has said so.
template <class Value>
std::vector<Value> whole(const std::vector<Value>& given, std::size_t sensors) {
  std::vector<Value> out;
  for (std::size_t i = 0; i < sensors; ++i) out.push_back(of_sensor(given, i));
  return out;
}

nlohmann::json place_json(const Eigen::Vector3d& x_m) { return {x_m[0], x_m[1], x_m[2]}; }

/// What only some rigs have.
void add_rest(const Scenario& s, nlohmann::json& out) {
  if (!s.is_cross()) out["positions_m"] = list(s.positions_m, &place_json);
  if (s.reference) {
    out["reference"] = {{"sd_nT", s.reference->sd_nT},
                        {"misalignment_deg", s.reference->misalignment_deg},
                        {"frame", s.reference->on_platform ? "platform" : "site"}};
  }
  if (s.cage) {
    out["cage"] = {{"fields", s.cage->sphere ? "sphere" : "random"},
                   {"max_nT", s.cage->max_nT},
                   {"poses", s.cage->poses}};
  }
  if (s.recording) {
    out["recording"] = {{"motion", motion_name(s.recording->motion)},
                        {"rate_hz", s.rate_hz},
                        {"duration_s", s.recording->duration_s},
                        {"rest_s", s.recording->rest_s}};
  }
}

nlohmann::json of_every_rig(const Scenario& s) {
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
            {"rate_error_percent", whole(s.rate_error_percent, s.sensors())},
            {"delivery_s", whole(s.delivery_s, s.sensors())},
            {"delivery_ppm", whole(s.delivery_ppm, s.sensors())}}},
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
          {"wiring", whole(s.wiring, s.sensors())},
          {"plugs", whole(s.plugs, s.sensors())},
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

}  // namespace

nlohmann::json truth_json(const Scenario& s) {
  nlohmann::json out = of_every_rig(s);
  add_rest(s, out);
  return out;
}

}  // namespace mgtd::rig
