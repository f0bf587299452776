// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/wrong_rows.h"

#include <algorithm>
#include <numeric>
#include <random>

#include "tests/rig/noise.h"

namespace mgtd::rig {

void turn_apart(Survey& survey, std::uint64_t seed) {
  for (std::size_t i = 1; i < survey.sensors; ++i) {
    std::mt19937_64 random = noise_stream(seed, static_cast<std::uint32_t>(32 + i));
    std::vector<std::size_t> order(survey.rows.size());
    std::iota(order.begin(), order.end(), 0U);
    std::shuffle(order.begin(), order.end(), random);
    const std::vector<SurveyRow> from = survey.rows;
    for (std::size_t k = 0; k < order.size(); ++k) {
      survey.rows[k].y_nT.at(i) = from[order[k]].y_nT.at(i);
      survey.rows[k].sd_nT.at(i) = from[order[k]].sd_nT.at(i);
      survey.rows[k].T_degC.at(i) = from[order[k]].T_degC.at(i);
    }
  }
}

void spoil(Survey& survey, const GrossReading& gross, const Scenario& scenario) {
  const double rail_nT = 1000 * scenario.uT_full_scale;
  for (std::size_t k = gross.pose - 1; k < std::min(survey.rows.size(), gross.pose - 1 + gross.poses); ++k) {
    for (AxisContext c; c.sensor < static_cast<int>(survey.sensors); ++c.sensor) {
      for (c.axis = 0; c.axis < 3; ++c.axis) {
        if (!gross.where.covers(c)) continue;
        const auto i = static_cast<std::size_t>(c.sensor);
        double& y_nT = survey.rows[k].y_nT.at(i)[c.axis];
        auto& sd_nT = survey.rows[k].sd_nT.at(i).at(static_cast<std::size_t>(c.axis));
        if (gross.kind == Gross::off) y_nT += gross.nT;
        if (gross.kind == Gross::stuck && k > 0) y_nT = survey.rows[k - 1].y_nT.at(i)[c.axis];
        if (gross.kind == Gross::saturated) y_nT = y_nT < 0 ? -rail_nT : rail_nT;
        if (gross.kind != Gross::off && sd_nT) sd_nT = 0;
      }
    }
  }
}

}  // namespace mgtd::rig
