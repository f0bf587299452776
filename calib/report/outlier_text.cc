// SPDX-License-Identifier: Apache-2.0
#include "calib/report/outlier_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace mgtd::calib::report {
namespace {

/// Nodes at one place in consecutive poses, for the same cause.
struct Stretch {
  const fit::OutlierNode *first, *last;
  double squares{0}, sigmas{0};
  int count{0};
};

std::string where_text(const fit::OutlierNode& node) {
  if (node.where == "pose") return "all sensors";
  if (node.where.size() == 2) return "sensor " + node.where;
  return node.where;
}

std::string text_of(const Stretch& s) {
  const fit::OutlierNode& node = *s.first;
  const std::string cause = node.cause.empty() ? "" : " " + node.cause + ",";
  const double rms = std::sqrt(s.squares / s.count);
  if (s.count == 1 && node.where == "pose") {
    return fmt::format("pose {} disturbed:{} its readings contradict the rest by {:.4g} nT (rms)", node.pose,
                       cause, rms);
  }
  if (s.count == 1) {
    return fmt::format("pose {}, {}:{} {:.4g} {} off, {:.0f} times what the other readings allow", node.pose,
                       node.where, cause, node.shift, node.unit, node.sigmas);
  }
  return fmt::format("poses {}-{} disturbed:{} {} contradict{} the rest by {:.4g} {} (rms)", node.pose,
                     s.last->pose, cause, where_text(node), node.where == "pose" ? "" : "s", rms, node.unit);
}

}  // namespace

std::vector<std::string> outlier_texts(const std::vector<fit::OutlierNode>& nodes) {
  std::vector<Stretch> stretches;
  for (const fit::OutlierNode& node : nodes) {
    const auto before = std::find_if(stretches.begin(), stretches.end(), [&](const Stretch& s) {
      return s.last->where == node.where && s.last->cause == node.cause && s.last->place + 1 == node.place;
    });
    Stretch& s = before != stretches.end() ? *before : stretches.emplace_back(Stretch{&node, &node});
    s.last = &node;
    s.squares += node.shift * node.shift;
    s.sigmas = std::max(s.sigmas, node.sigmas);
    ++s.count;
  }
  std::vector<std::string> out;
  for (const Stretch& s : stretches) out.push_back(text_of(s));
  return out;
}

}  // namespace mgtd::calib::report
