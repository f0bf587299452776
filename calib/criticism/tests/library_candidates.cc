// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "calib/criticism/tests/candidate_effect.h"
#include "calib/effects/laws/run_memory.h"
#include "calib/effects/laws/site_dipole.h"
#include "calib/effects/laws/site_step.h"
#include "calib/effects/library/effect_family.h"
#include "calib/linear/parts.h"

namespace mgtd::calib::criticism::tests {
namespace {

/// Of a searched number no more values are tried at first: neighbours are alike, and what comes near the
/// winner is refined. An instant is determined more sharply than a smooth number.
constexpr std::size_t kVariants = 10, kInstants = 20;

/// Values of the searched number; an empty one is the form without it.
std::vector<std::optional<double>> variants(const effects::library::EffectFamily& family,
                                            const effects::EffectContext& context) {
  if (!family.scan) return {std::nullopt};
  const std::vector<double> all = effects::library::scan_values(family, context);
  std::vector<std::optional<double>> out;
  if (family.scan->optional) out.emplace_back(std::nullopt);
  const bool instant = family.scan->range == effects::library::Scan::Range::run;
  const std::size_t n = std::min(all.size(), instant ? kInstants : kVariants);
  for (std::size_t i = 0; i < n; ++i) out.emplace_back(all[n < 2 ? 0 : i * (all.size() - 1) / (n - 1)]);
  return out;
}

/// What a hypothesis is called in a spec; empty for an effect as a whole.
std::optional<effects::Where> where_of(const Hypothesis& hypothesis) {
  const auto where = effects::Where::parse(hypothesis.where);
  if (!where || where->scale == effects::Where::Scale::own) return std::nullopt;
  return *where;
}

/// Half-way between two values; of instants one that lies between poses.
std::function<std::optional<double>(double, double)> between(const effects::library::EffectFamily& family,
                                                             const effects::EffectContext& context) {
  if (!family.scan || family.scan->range == effects::library::Scan::Range::index) return {};
  const effects::library::Scan scan = *family.scan;
  if (scan.range == effects::library::Scan::Range::logarithmic)
    return [](double lower, double upper) { return std::optional(std::sqrt(lower * upper)); };
  if (scan.range == effects::library::Scan::Range::linear)
    return [](double lower, double upper) { return std::optional((lower + upper) / 2); };
  return [gaps = effects::library::run_gaps_h(context)](double lower, double upper) -> std::optional<double> {
    const auto first = std::upper_bound(gaps.begin(), gaps.end(), lower);
    const auto last = std::lower_bound(first, gaps.end(), upper);
    if (first == last) return std::nullopt;
    return *(first + (last - first) / 2);
  };
}

/// The form of a law of the site that is a dipole.
decltype(CandidateEffect::dipole_at) dipole_of(const effects::library::EffectFamily& family) {
  if (family.name == effects::laws::SiteDipole::kName)
    return [](const Eigen::Vector3d& place_S_m, const std::optional<double>&) -> Result<effects::EffectPtr> {
      return std::make_shared<const effects::laws::SiteDipole>(place_S_m);
    };
  if (family.name == effects::laws::SiteStep::kName)
    return [](const Eigen::Vector3d& place_S_m,
              const std::optional<double>& ts_h) -> Result<effects::EffectPtr> {
      return std::make_shared<const effects::laws::SiteStepDipole>(ts_h.value_or(0), place_S_m);
    };
  return {};
}

CandidateEffect candidate_effect_of(const effects::library::EffectFamily& family,
                                    const effects::EffectContext& context) {
  CandidateEffect out{.name = std::string(family.name),
                      .level = family.level,
                      .typical = family.typical,
                      .bound = family.bound,
                      .reads = std::string(family.needs)};
  const auto values = variants(family, context);
  std::vector<effects::EffectPtr> made(values.size());  // null where there is none
  linear::for_each_part(values.size(), [&](std::size_t i) {
    if (auto effect = effects::library::make(family, std::nullopt, values[i], context))
      made[i] = *std::move(effect);
  });
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!made[i]) continue;
    out.variants.push_back(std::move(made[i]));
    out.values.push_back(values[i]);
  }
  if (family.scan) out.parameter = family.scan->parameter;
  if (!out.variants.empty()) out.hypotheses = hypotheses_of(*out.variants.front(), context.sensors());
  out.make = [&family, context](const Hypothesis* h, const std::optional<double>& value) {
    return effects::library::make(family, h == nullptr ? std::nullopt : where_of(*h), value, context);
  };
  out.between = between(family, context);
  if (family.scan && family.scan->range == effects::library::Scan::Range::run)
    out.instants = effects::library::run_gaps_h(context);
  out.dipole_at = dipole_of(family);
  return out;
}

bool by_temperature(const effects::library::EffectFamily& family) {
  return family.name.find("temperature") != std::string_view::npos ||
         family.name.find("thermal") != std::string_view::npos;
}

bool temperature_changes(const PoseTable& table) {
  constexpr double kNoChange_degC = 1e-6;
  for (std::size_t i = 0; i < table.poses.front().T_degC.size(); ++i) {
    std::optional<double> low, high;
    for (const Pose& pose : table.poses) {
      if (!pose.T_degC[i]) continue;
      low = std::min(low.value_or(*pose.T_degC[i]), *pose.T_degC[i]);
      high = std::max(high.value_or(*pose.T_degC[i]), *pose.T_degC[i]);
    }
    if (low && *high - *low > kNoChange_degC) return true;
  }
  return false;
}

/// The list says whose reason it is.
std::string without_name(std::string message, std::string_view name) {
  if (!message.starts_with(name)) return message;
  message.erase(0, name.size());
  return message.substr(std::min(message.size(), message.find_first_not_of(": ")));
}

}  // namespace

CandidateEffects library_candidates(const PoseTable& table, const std::vector<effects::EffectPtr>& left_out) {
  CandidateEffects out;
  effects::EffectContext context{.table = &table, .offset_nT = {}};
  if (const auto memory = effects::laws::run_memory(context)) context.memory = *memory;
  for (const effects::library::EffectFamily& family : effects::library::effect_families()) {
    if (std::any_of(left_out.begin(), left_out.end(),
                    [&](const effects::EffectPtr& e) { return e->name() == family.name; }))
      continue;
    if (!family.untestable.empty()) {
      out.untestable.push_back({std::string(family.name), std::string(family.untestable)});
      continue;
    }
    const auto values = variants(family, context);
    if (values.empty()) {  // a time within the run, and the poses tell none
      out.untestable.push_back({std::string(family.name), "needs t_s"});
      continue;
    }
    const auto effect = effects::library::make(family, std::nullopt, values.front(), context);
    const auto ok = effect ? (*effect)->applicable(table) : tl::unexpected(effect.error());
    if (!ok) {
      std::string why = without_name(ok.error().message, family.name);
      const std::size_t lacking = effect ? (*effect)->lack_of(table).poses : 0;
      if (lacking > 0 && lacking < table.poses.size())
        why += ": fill it in, or leave those poses out of the table";
      out.untestable.push_back({std::string(family.name), std::move(why)});
      continue;
    }
    if (by_temperature(family) && !temperature_changes(table)) {
      out.untestable.push_back({std::string(family.name), "the temperatures of these poses never change"});
      continue;
    }
    out.testable.push_back(candidate_effect_of(family, context));
  }
  return out;
}

}  // namespace mgtd::calib::criticism::tests
