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
  const std::size_t given = report.fit ? report.fit->problem.effects.size() : 0;
  std::set<std::string> kept;
  for (std::size_t i = given; i < report.model.size(); ++i)
    if (!holds(stand_ins, report.model[i]->spec())) kept.emplace(report.model[i]->name());
  std::erase_if(report.named, [&](const std::string& name) { return !kept.contains(name); });
  if (report.named.empty() || report.named.front() != first) report.next.clear();
  report.stand_ins = stand_ins;
  report.finding = report.named.empty() ? Finding::unknown : Finding::partial;
}

}  // namespace mgtd::calib::criticism::search
