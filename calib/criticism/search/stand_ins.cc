// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/search/stand_ins.h"

#include <algorithm>
#include <set>

#include "calib/effects/added_effects.h"

namespace mgtd::calib::criticism::search {
namespace {

bool holds(const std::vector<std::string>& all, const std::string& one) {
  return std::find(all.begin(), all.end(), one) != all.end();
}

}  // namespace

void take_back_stand_ins(const std::vector<std::string>& stand_ins, ExplainReport& report) {
  if (stand_ins.empty()) return;
  const std::string first = report.named.empty() ? "" : report.named.front();
  const std::vector<effects::EffectPtr> given =
      report.fit ? report.fit->problem.effects : std::vector<effects::EffectPtr>{};
  std::set<std::string> taken_back, kept;
  for (const effects::EffectPtr& effect : effects::added_effects(report.model, given))
    (holds(stand_ins, effect->spec()) ? taken_back : kept).emplace(effect->name());
  std::erase_if(report.named,
                [&](const std::string& name) { return taken_back.contains(name) && !kept.contains(name); });
  if (report.named.empty() || report.named.front() != first) report.next.clear();
  report.stand_ins = stand_ins;
  report.finding = report.named.empty() ? Finding::unknown : Finding::partial;
}

}  // namespace mgtd::calib::criticism::search
