// SPDX-License-Identifier: Apache-2.0
#include "calib/report/explain_json.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "calib/report/explain_note_text.h"
#include "calib/report/json_number.h"
#include "calib/report/verdict_text.h"

namespace mgtd::calib::report {
namespace {

using nlohmann::json;

json coefficient_json(const calibration::EffectCoefficient& c) {
  return {{"name", c.name}, {"value", c.value}, {"sd", c.sd}, {"unit", c.unit}};
}

json plain_candidate_json(const criticism::tests::Candidate& c) {
  json coefficients = json::array(), alternatives = json::array();
  for (const calibration::EffectCoefficient& x : c.coefficients) coefficients.push_back(coefficient_json(x));
  for (const criticism::tests::Alternative& r : c.alternatives) {
    alternatives.push_back({{"effect", r.effect},
                            {"where", r.where},
                            {"p_behind", r.p_behind},
                            {"p_right", r.p_right},
                            {"possible", r.possible}});
  }
  return {{"effect", c.effect},
          {"where", c.where},
          {"spec", c.spec},
          {"k", c.k},
          {"log10_p", c.log10_p},
          {"p", std::pow(10.0, c.log10_p)},
          {"d", c.d},
          {"predicted_fall", c.fall},
          {"share", std::isfinite(c.share) ? json(c.share) : json()},
          {"coefficients", std::move(coefficients)},
          {"rivals", std::move(alternatives)},
          {"plausible", c.plausible},
          {"poses", c.poses},
          {"largest_pose_share", c.largest_pose}};
}

json candidate_json(const criticism::tests::Candidate& c) {
  json out = plain_candidate_json(c);
  if (!c.impact) return out;
  out["impact_nT_per_m"] = number_or_null(c.impact->nT_per_m);
  out["impact_component"] = c.impact->component.empty() ? json() : json(c.impact->component);
  return out;
}

json rows_json(const Eigen::MatrixXd& matrix) {
  json out = json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    json row = json::array();
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) row.push_back(matrix(i, j));
    out.push_back(std::move(row));
  }
  return out;
}

json round_json(const criticism::search::Round& r) {
  return {{"added", candidate_json(r.added)}, {"possible", r.possible},
          {"chi2_before", r.chi2_before},     {"chi2_after", r.chi2_after},
          {"rms_before_nT", r.rms_before_nT}, {"rms_after_nT", r.rms_after_nT}};
}

template <class T, class F>
json array_of(const std::vector<T>& values, F&& make) {
  json out = json::array();
  for (const T& value : values) out.push_back(make(value));
  return out;
}

}  // namespace

json to_json(const criticism::tests::MapScore& m) {
  return {{"map", m.map},         {"where", m.where}, {"p", std::pow(10.0, m.log10_p)},
          {"log10_p", m.log10_p}, {"chi2", m.S},      {"k", m.k}};
}

json to_json(const criticism::tests::NoiseModel& n) {
  json out{{"from", !n.reference.known           ? "residual"
                    : std::isinf(n.reference.nu) ? "dwells"
                                                 : "revisits"},
           {"pose_mean_from", n.known ? "dwells" : "residual"},
           {"pose_correlation", n.rho},
           {"scale", std::sqrt(n.reference.scale2)},
           {"beyond_dwells", n.beyond_dwells},
           {"quantisation_nT", n.quantisation_nT},
           {"slow_nT_per_sqrt_h", n.wandering.any() ? n.wandering.size.maxCoeff() : 0.0},
           {"slow_where", n.wandering.where}};
  out["between_revisits"] =
      n.revisits ? json{{"pairs", n.revisits->pairs}, {"ratio", n.revisits->ratio}, {"dof", n.revisits->nu}}
                 : json();
  return out;
}

json to_json(const criticism::tests::Candidate& c) { return candidate_json(c); }

json to_json(const criticism::tests::ConfusionMatrix& c) {
  return {{"effects", c.effects},
          {"where", c.where},
          {"correlation", rows_json(c.correlation)},
          {"p_right", rows_json(c.p_right)}};
}

json to_json(const criticism::search::ExplainReport& r) {
  json lack;
  if (r.noise.revisits) {
    const criticism::tests::PureError& p = *r.noise.revisits;
    lack = {{"F", p.F}, {"p", std::pow(10.0, p.log10_p)}, {"model_nT", p.model_nT}, {"pairs", p.pairs}};
  }
  json out{
      {"schema", "mgt.explain/1"},
      {"verdict", to_string(r.finding)},
      {"candidates", array_of(r.candidates, candidate_json)},
      {"named", r.named},
      {"stand_ins", r.stand_ins},
      {"rounds", array_of(r.rounds, round_json)},
      {"maps", array_of(r.maps, [](const criticism::tests::MapScore& m) { return to_json(m); })},
      {"maps_left", array_of(r.maps_left, [](const criticism::tests::MapScore& m) { return to_json(m); })},
      {"noise", to_json(r.noise)},
      {"noise_nT", r.noise_nT},
      {"residual_nT", r.residual_nT},
      {"chi2", r.chi2},
      {"dof", r.dof},
      {"omnibus_p", std::pow(10.0, r.omnibus_log10_p)},
      {"share_of", share_of(r)},
      {"lack_of_fit", std::move(lack)},
      {"detectable_above", array_of(r.detectable,
                                    [](const criticism::tests::Detectable& d) {
                                      const bool of_a_size = d.value < criticism::tests::kAtNoSize;
                                      return json{{"effect", d.effect},
                                                  {"where", d.where},
                                                  {"value", of_a_size ? json(d.value) : json()},
                                                  {"unit", d.unit},
                                                  {"text", detectable_text(d)}};
                                    })},
      {"untestable", array_of(r.untestable,
                              [](const criticism::tests::Untestable& u) {
                                return json{{"effect", u.effect}, {"why", u.why}};
                              })},
      {"next", array_of(r.next,
                        [](const design::NextMeasurement& n) {
                          return json{{"action", n.action},
                                      {"minutes", n.minutes},
                                      {"p_right_before", n.p_right_before},
                                      {"p_right_after", n.p_right_after}};
                        })},
      {"notes", note_texts(r.notes)},
      {"text", sentence(r)}};
  if (r.confusion) out["confusion"] = to_json(*r.confusion);
  return out;
}

}  // namespace mgtd::calib::report
