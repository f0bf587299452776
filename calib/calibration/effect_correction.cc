// SPDX-License-Identifier: Apache-2.0
#include "calib/calibration/effect_correction.h"

#include "calib/effects/library/library.h"
#include "calib/linear/propagation.h"

namespace mgtd::calib::calibration {
namespace {

std::vector<effects::EffectPtr> effects_of(const Calibration& c, const PoseTable* run) {
  std::vector<effects::EffectPtr> out;
  for (const CalibratedEffect& e : c.effects)
    out.push_back(*effects::library::make_effect(e.effect, static_cast<int>(c.sensors.size())));
  if (run == nullptr) return out;
  effects::EffectContext context{.table = run, .offset_nT = PerSensor<Eigen::Vector3d>(0)};
  for (const sensor::SensorModel& sensor : c.sensors) context.offset_nT->push_back(sensor.offset_nT);
  auto bound = effects::library::bound_to_run(out, context);
  return bound ? std::move(*bound) : out;
}

Eigen::VectorXd coefficients_of(const Calibration& c) {
  std::vector<double> values;
  for (const CalibratedEffect& e : c.effects) {
    for (const EffectCoefficient& coefficient : e.coefficients) values.push_back(coefficient.value);
  }
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

}  // namespace

EffectCorrection::EffectCorrection(const Calibration& c, const PoseTable* run)
    : EffectCorrection(c, effects_of(c, run)) {}

EffectCorrection::EffectCorrection(const Calibration& c, std::vector<effects::EffectPtr> effects)
    : effects_(std::move(effects)),
      array_(c.sensors, c.geometry, effects_, coefficients_of(c)),
      covariance_(full_covariance(c)),
      means_(c.reference.currents_A) {
  for (const CalibratedEffect& e : c.effects) size2_nT2_.push_back(e.size_nT.cwiseAbs2());
  if (const auto start = parse_utc(c.reference.t_utc)) time_.start = *start;
}

EffectCorrection EffectCorrection::live(const Calibration& c) {
  std::vector<effects::EffectPtr> effects = effects_of(c, nullptr);
  std::vector<std::shared_ptr<effects::laws::LiveMemory>> memories;
  for (effects::EffectPtr& effect : effects) {
    auto [remembering, memory] = effect->live();
    if (!memory) continue;
    effect = std::move(remembering);
    memories.push_back(std::move(memory));
  }
  EffectCorrection out(c, std::move(effects));
  out.memories_ = std::move(memories);
  return out;
}

bool EffectCorrection::acts(const effects::Effect& effect, bool remove_site) const {
  return effect.level() == effects::Level::axis || effect.level() == effects::Level::platform ||
         (remove_site && effect.level() == effects::Level::site);
}

std::vector<EffectCorrection::LeftOut> EffectCorrection::left_out(const Pose& pose, bool remove_site) const {
  std::vector<LeftOut> out;
  for (const effects::EffectPtr& effect : effects_) {
    const std::string_view column = effect->missing(pose);
    if (!column.empty() && acts(*effect, remove_site)) out.push_back({effect->name(), column});
  }
  return out;
}

sensor::ChannelCovariance EffectCorrection::covariance(const effects::Conditions& at,
                                                       const sensor::FieldVector& b_P_nT,
                                                       const std::optional<Eigen::Matrix3d>& R,
                                                       bool remove_site) const {
  const Eigen::MatrixXd d = array_.derivative(at, b_P_nT, R, remove_site);
  sensor::ChannelCovariance out = linear::propagated_covariance(d, covariance_);
  for (std::size_t e = 0; e < effects_.size(); ++e) {
    if (acts(*effects_[e], remove_site) && !effects_[e]->missing(at.pose).empty())
      out.diagonal() += size2_nT2_[e];
  }
  return out;
}

std::optional<Eigen::Matrix3d> EffectCorrection::attitude_for_instrument(
    const effects::Conditions& at) const {
  if (!array_.has_platform_effects() || !at.pose.angles()) return std::nullopt;
  return array_.attitude(at);
}

sensor::FieldVector EffectCorrection::fields(const Pose& pose, const sensor::FieldVector& y_nT) const {
  const effects::Conditions at{pose, time_.hours(pose), nullptr, &means_};
  return array_.correct(at, y_nT, attitude_for_instrument(at));
}

sensor::ChannelCovariance EffectCorrection::covariance(const Pose& pose,
                                                       const sensor::FieldVector& b_P_nT) const {
  const effects::Conditions at{pose, time_.hours(pose), nullptr, &means_};
  return covariance(at, b_P_nT, attitude_for_instrument(at), false);
}

Corrected EffectCorrection::correct(const Pose& pose, const sensor::FieldVector& y_nT, bool remove_site,
                                    const Pose* previous) const {
  const effects::Conditions at{pose, time_.hours(pose), previous, &means_};
  std::optional<Eigen::Matrix3d> R;
  if (pose.angles()) R = array_.attitude(at);
  Corrected out{.b_P_nT = array_.correct(at, y_nT, R), .covariance = {}};
  out.covariance = covariance(at, out.b_P_nT, R, remove_site);
  if (remove_site && R) out.b_P_nT -= array_.site_field(at, *R);
  return out;
}

}  // namespace mgtd::calib::calibration
