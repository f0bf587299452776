// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/library/effect_family.h"

#include <algorithm>
#include <cmath>

#include "calib/poses/run_time.h"

namespace mgtd::calib::effects::library {
namespace {

std::vector<double> run_values(const Scan& scan, const EffectContext& context) {
  std::vector<double> out;
  const std::vector<double> gaps = run_gaps_h(context);
  if (gaps.empty()) return out;
  const double last = static_cast<double>(gaps.size() - 1);
  for (int i = 0; i < scan.steps; ++i) {
    const double share = scan.from + (scan.to - scan.from) * i / (scan.steps - 1);
    const double t = gaps[static_cast<std::size_t>(std::lround(share * last))];
    if (out.empty() || t > out.back()) out.push_back(t);
  }
  return out;
}

}  // namespace

std::span<const EffectFamily> effect_families() {
  static const std::vector<EffectFamily> all = [] {
    std::vector<EffectFamily> out;
    for (const auto part :
         {axis_families(), nonlinearity_families(), platform_families(), table_families(), site_families()})
      out.insert(out.end(), part.begin(), part.end());
    return out;
  }();
  return all;
}

const EffectFamily* find_family(std::string_view name) {
  const auto all = effect_families();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const EffectFamily& f) { return f.name == name; });
  return found == all.end() ? nullptr : &*found;
}

std::vector<double> run_gaps_h(const EffectContext& context) {
  std::vector<double> t, out;
  if (context.table == nullptr) return out;
  const poses::RunTime time = poses::RunTime::of(*context.table);
  for (const Pose& pose : context.table->poses) t.push_back(time.hours(pose));
  std::sort(t.begin(), t.end());
  for (std::size_t k = kStepPoses; k + kStepPoses <= t.size(); ++k) {
    if (t[k] > t[k - 1]) out.push_back((t[k] + t[k - 1]) / 2);
  }
  return out;
}

std::vector<double> scan_values(const EffectFamily& family, const EffectContext& context) {
  if (!family.scan) return {};
  const Scan& scan = *family.scan;
  if (scan.range == Scan::Range::run) return run_values(scan, context);
  std::vector<double> out;
  for (int i = 0; i < scan.steps; ++i) {
    const double share = i / (scan.steps - 1.0);
    out.push_back(scan.range == Scan::Range::logarithmic ? scan.from * std::pow(scan.to / scan.from, share)
                                                         : scan.from + (scan.to - scan.from) * share);
  }
  return out;
}

Result<EffectPtr> make(const EffectFamily& family, std::optional<Where> where, std::optional<double> scan,
                       const EffectContext& context) {
  EffectSpec spec{.name = std::string(family.name), .where = where, .parameters = {}};
  if (scan && family.scan) spec.set(family.scan->parameter, *scan);
  return make_effect(spec, context);
}

}  // namespace mgtd::calib::effects::library
