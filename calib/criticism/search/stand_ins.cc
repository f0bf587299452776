// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/search/stand_ins.h"

#include <algorithm>
#include <set>

namespace mgtd::calib::criticism::search {
namespace {

bool holds(const std::vector<std::string>& all, const std::string& one) {
  return std::find(all.begin(), all.end(), one) != all.end();
}

}  // namespace

void take_back_stand_ins(const std::vector<std::string>& stand_ins, ExplainReport& report) {
  if (stand_ins.empty()) return;
  const std::string first = report.named.empty() ? "" : report.named.front();
  const std::vector<std::string> given =
      report.fit ? effects::specs_of(report.fit->problem.effects) : std::vector<std::string>{};
  std::set<std::string> taken_back, kept;
  for (const effects::EffectPtr& effect : report.model) {
    if (holds(given, effect->spec())) continue;
    (holds(stand_ins, effect->spec()) ? taken_back : kept).emplace(effect->name());
  }
  std::erase_if(report.named,
                [&](const std::string& name) { return taken_back.contains(name) && !kept.contains(name); });
  if (report.named.empty() || report.named.front() != first) report.next.clear();
  report.stand_ins = stand_ins;
  report.finding = report.named.empty() ? Finding::unknown : Finding::partial;
}

}  // namespace mgtd::calib::criticism::search
