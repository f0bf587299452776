// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/laws/site_step.h"

#include "calib/effects/laws/axis_offset.h"
#include "calib/effects/laws/site_gradient.h"
#include "calib/poses/run_time.h"

namespace mgtd::calib::effects::laws {
namespace {

std::string_view missing_angle_or_time(const Pose& pose) {
  const auto angle = missing_angle(pose);
  return angle.empty() ? poses::missing_time(pose) : angle;
}

}  // namespace

SiteStep::SiteStep(std::optional<double> ts_h) : ts_h_(ts_h) {
  constexpr double kPrior_nT = 1000;
  for (const char* name : {"Bx", "By", "Bz"}) add(name, "nT", 20, kPrior_nT);
  for (const char* name : kGradientComponents) add(name, "nT/m", 20);
}

std::string SiteStep::spec() const {
  EffectSpec out{.name = std::string(kName), .where = {}, .parameters = {}};
  if (ts_h_) out.set("ts", *ts_h_);
  return out.text();
}

Result<std::shared_ptr<const Effect>> SiteStep::bound(const EffectContext& context) const {
  const auto middle = middle_h(context);
  if (ts_h_ || !middle) return std::shared_ptr<const Effect>();
  return std::make_shared<const SiteStep>(*middle);
}

std::string_view SiteStep::missing(const Pose& pose) const { return missing_angle_or_time(pose); }

SiteStepDipole::SiteStepDipole(double ts_h, const Eigen::Vector3d& place_S_m)
    : ts_h_(ts_h), start_S_m_(place_S_m) {
  constexpr double kShiftPrior_m = 0.5;
  for (const char* name : {"mx", "my", "mz"}) add(name, "A m^2", 0.1);
  for (const char* name : {"dx", "dy", "dz"}) add(name, "m", 0.3, kShiftPrior_m);
}

std::string SiteStepDipole::spec() const {
  EffectSpec out{.name = std::string(kName), .where = {}, .parameters = {}};
  out.set("ts", ts_h_);
  set_dipole_place(start_S_m_, out);
  return out.text();
}

std::string_view SiteStepDipole::missing(const Pose& pose) const { return missing_angle_or_time(pose); }

}  // namespace mgtd::calib::effects::laws
