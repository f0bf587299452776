// SPDX-License-Identifier: Apache-2.0
#include "calib/calibration/live_tensor.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "calib/linear/propagation.h"

namespace mgtd::calib::calibration {
namespace {

constexpr double kTurned = 2e-3;  // of the field, relative

}  // namespace

LiveTensor::LiveTensor(const sensor::Geometry& geometry) : pipeline_(geometry) {}

LiveTensor::LiveTensor(const std::shared_ptr<const Calibration>& calibration) : pipeline_(calibration) {
  if (pipeline_.effects() == nullptr || !pipeline_.effects()->has_instrument_effects()) return;
  effects_ = std::make_unique<const EffectCorrection>(EffectCorrection::live(*calibration));
  for (const auto& [effect, column] : effects_->left_out(now_, false))
    left_out_.push_back({std::string(effect), std::string(column)});
}

/// Everything the effects may ask for, and the memories moved on to this epoch.
void LiveTensor::look_around(const Epoch& epoch, const LiveConditions& conditions) {
  now_.y_nT = epoch.y_nT;
  if (effects_->knows_start()) now_.t_utc = epoch.t.wall;
  now_.T_degC.resize(epoch.T_degC.size());
  for (std::size_t i = 0; i < epoch.T_degC.size(); ++i)
    now_.T_degC[i] = std::isfinite(epoch.T_degC[i]) ? std::optional(epoch.T_degC[i]) : std::nullopt;
  now_.azimuth_rad.reset();
  now_.pitch_rad.reset();
  now_.roll_rad.reset();
  if (const auto& angles = conditions.angles) {
    now_.azimuth_rad = angles->azimuth_rad;
    now_.pitch_rad = angles->pitch_rad;
    now_.roll_rad = angles->roll_rad;
  }
  if (conditions.covariates != nullptr) now_.covariates = *conditions.covariates;
  if (effects_->memories().empty()) return;
  effects::laws::SensorReadings v_nT(epoch.y_nT.size());
  for (std::size_t i = 0; i < v_nT.size(); ++i) v_nT[i] = epoch.y_nT[i] - calibration()->sensors[i].offset_nT;
  for (const auto& memory : effects_->memories())
    memory->follow(to_seconds(epoch.t.mono.time_since_epoch()), v_nT);
}

void LiveTensor::refresh(const sensor::FieldVector& b_P_nT) {
  const sensor::ChannelCovariance covariance = effects_->covariance(now_, b_P_nT);
  g_sd_nT_per_m_ = pipeline_.gradient_sd(covariance, 1);
  along_line_sd_nT_per_m_ = pipeline_.along_line_sd(covariance, 1);
  const auto C = closure_rows(calibration()->geometry);
  if (C.rows() == 4) {
    closure_weight_ =
        Eigen::Matrix4d(linear::propagated_covariance(C, covariance + pipeline_.sample_noise())).inverse();
  } else if (C.rows() > 0) {
    closure_weight_ = linear::propagated_covariance(C, covariance + pipeline_.sample_noise()).inverse();
  }
  at_P_nT_ = b_P_nT.head<3>();
  fresh_ = kRefresh;
}

TensorSample LiveTensor::apply(const Epoch& epoch, const LiveConditions& conditions) {
  if (!effects_) return pipeline_.apply(epoch, 1, &fields_P_nT_);
  look_around(epoch, conditions);
  fields_P_nT_ = effects_->fields(now_, stacked(epoch.y_nT));
  TensorSample out = pipeline_.sample(fields_P_nT_);

  const auto lacking = effects_->left_out(now_, false);
  const auto same = [](const EffectCorrection::LeftOut& now, const LeftOutEffect& before) {
    return now.effect == before.effect && now.column == before.lacks;
  };
  if (!std::equal(lacking.begin(), lacking.end(), left_out_.begin(), left_out_.end(), same)) {
    left_out_.clear();
    for (const auto& [effect, column] : lacking)
      left_out_.push_back({std::string(effect), std::string(column)});
    fresh_ = 0;
  }
  if (!lacking.empty()) out.flags |= Flag::incomplete;

  if (pipeline_.noise_known()) {
    const bool turned = (fields_P_nT_.head<3>() - at_P_nT_).norm() > kTurned * at_P_nT_.norm();
    if (--fresh_ < 0 || turned) refresh(fields_P_nT_);
    out.g_sd_nT_per_m = g_sd_nT_per_m_;
    if (out.along_line) out.along_line->sd_nT_per_m = along_line_sd_nT_per_m_;
    if (out.closure.dof > 0) {
      const sensor::FieldVector closure = closure_numbers(out.closure);
      out.closure.chi2 = sensor::over_rows<4>(closure.size(), [&](auto n) {
        return closure.head(n).dot(closure_weight_.topLeftCorner(n, n) * closure.head(n));
      });
    }
  }
  out.seq = epoch.seq;
  out.t = epoch.t;
  out.skew_bound_s = epoch.skew_bound_s;
  out.flags |= epoch.flags;
  return out;
}

}  // namespace mgtd::calib::calibration
