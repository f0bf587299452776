// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/laws/site_drift.h"

#include <algorithm>

namespace mgtd::calib::effects::laws {

FieldDrift::FieldDrift(std::optional<double> hours) : hours_(hours) {
  constexpr double kPrior_nT = 200;
  for (int k = 1; k <= kTerms; ++k) {
    for (const char axis : {'x', 'y', 'z'}) add("cos" + std::to_string(k) + "." + axis, "nT", 20, kPrior_nT);
  }
}

std::string FieldDrift::spec() const {
  EffectSpec out{.name = std::string(kName), .where = {}, .parameters = {}};
  if (hours_) out.set("hours", *hours_);
  return out.text();
}

Result<std::shared_ptr<const Effect>> FieldDrift::bound(const EffectContext& context) const {
  if (hours_ || context.table == nullptr) return std::shared_ptr<const Effect>();
  const poses::RunTime time = poses::RunTime::of(*context.table);
  double last = 0;
  for (const Pose& pose : context.table->poses) last = std::max(last, time.hours(pose));
  if (!(last > 0)) {
    return fail(ErrorCode::refused, "site.field-drift: the poses have no times",
                "give t_s or t_utc of every pose");
  }
  return std::make_shared<const FieldDrift>(last);
}

GradientDrift::GradientDrift(std::optional<double> ts_h) : ts_h_(ts_h) {
  for (const char* name : kGradientComponents) add(name, ts_h ? "nT/m" : "nT/m/h", 10);
}

std::string GradientDrift::spec() const {
  EffectSpec out{.name = std::string(kName), .where = {}, .parameters = {}};
  if (ts_h_) out.set("ts", *ts_h_);
  return out.text();
}

}  // namespace mgtd::calib::effects::laws
