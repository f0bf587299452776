// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/recording.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tests/rig/simulated_table.h"
#include "tests/rig/world.h"
#include "tests/rig/wrong_rows.h"

namespace mgtd::rig {
namespace {

constexpr double kResolution_nT = 1e-3;  ///< of what is written down

void measure(World& world, double t_s, SurveyRow& row) {
  const Scenario& s = world.scenario();
  row.t_s = t_s;
  for (std::size_t i = 0; i < world.sensors(); ++i)
    row.y_nT[i] = i > 0 && s.copied > 0 ? row.y_nT[0] : world.read_sensor(static_cast<int>(i), t_s);
  if (s.scalar) row.f_nT = world.read_scalar(t_s);
  if (s.reference) {
    row.ref_nT = world.quiet_reference(t_s) + s.reference->sd_nT * world.reference_noise();
    row.ref_sd_nT = std::max(kResolution_nT, s.reference->sd_nT);
  }
  if (s.angles) {
    const TableAngles angles = recorded_angles_of(world.attitude(t_s));
    row.azimuth_rad = angles.azimuth_rad;
    row.pitch_rad = angles.pitch_rad;
    row.roll_rad = angles.roll_rad;
  }
  for (const Covariate& c : s.covariates) {
    if (c.recorded) row.covariates[c.name] = c.at(t_s);
  }
}

}  // namespace

Survey simulated_recording(Scenario scenario) {
  World world(std::move(scenario));
  const Scenario& s = world.scenario();
  Survey out{.sensors = world.sensors(), .rows = {}};
  out.dwells = out.turned = false;
  out.angles = s.angles;
  out.scalar = s.scalar;
  if (!s.recording) return out;
  world.carry(std::make_shared<Motion>(*s.recording, s.seed));
  const auto rows = static_cast<std::size_t>(std::floor(s.recording->duration_s * s.rate_hz + 1e-9));
  out.rows.reserve(rows);
  for (std::size_t k = 0; k < rows; ++k) {
    SurveyRow& row = out.rows.emplace_back(world.sensors());
    row.number = static_cast<int>(k) + 1;
    measure(world, static_cast<double>(k) / s.rate_hz, row);
  }
  if (s.apart) turn_apart(out, s.seed);
  for (const GrossReading& gross : s.gross) spoil(out, gross, s);
  return out;
}

}  // namespace mgtd::rig
