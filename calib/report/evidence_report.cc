// SPDX-License-Identifier: Apache-2.0
#include "calib/report/evidence_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "calib/report/explain_json.h"
#include "calib/report/json_number.h"
#include "calib/report/residual_columns_report.h"
#include "calib/report/shown_number.h"
#include "calib/report/size_text.h"
#include "calib/stats/probability.h"

namespace mgtd::calib::report {
namespace {

using criticism::search::Evidence;
using nlohmann::json;

constexpr std::size_t kMapsInText = 6, kAlternativesInText = 6, kPosesInText = 12;

json left_json(const criticism::search::Left& left) {
  json maps = json::array();
  for (const criticism::tests::MapScore& map : left.maps) maps.push_back(to_json(map));
  json out{{"residual_nT", left.residual_nT},
           {"noise_nT", left.noise_nT},
           {"chi2", left.chi2},
           {"dof", left.dof},
           {"maps", std::move(maps)}};
  if (left.by_pose) out["poses"] = to_json(*left.by_pose);
  return out;
}

/// The map of the same name and place; null where there is none.
const criticism::tests::MapScore* same_map(const std::vector<criticism::tests::MapScore>& maps,
                                           const std::string& name) {
  const auto found = std::find_if(maps.begin(), maps.end(), [&](const auto& m) { return m.map == name; });
  return found == maps.end() ? nullptr : &*found;
}

void tell_poses(const criticism::tests::Candidate& c, std::string& out) {
  std::vector<int> poses = c.poses;
  const std::size_t all = poses.size();
  if (poses.size() > kPosesInText) poses.resize(kPosesInText);
  out += fmt::format("{} {} half of the evidence: {}{}; the heaviest has {:.0f} % of it\n", all,
                     all == 1 ? "pose carries" : "poses carry", fmt::join(poses, ", "),
                     all > poses.size() ? ", ..." : "", 100 * c.largest_pose);
}

void tell_maps(const Evidence& e, std::string& out) {
  const auto to = std::back_inserter(out);
  fmt::format_to(to, "\n{:<32} {:>12} {:>12}\n", "residual against", "p without it", "p with it");
  for (std::size_t i = 0; i < std::min(kMapsInText, e.before.maps.size()); ++i) {
    const criticism::tests::MapScore& before = e.before.maps[i];
    const criticism::tests::MapScore* const after = same_map(e.after.maps, before.map);
    fmt::format_to(to, "{:<32} {:>12} {:>12}\n", before.map, stats::p_text(before.log10_p),
                   after != nullptr ? stats::p_text(after->log10_p) : "-");
  }
}

void tell_alternatives(const Evidence& e, std::string& out) {
  const auto to = std::back_inserter(out);
  const auto& all = e.candidate.alternatives;
  if (all.empty()) {
    out += "\nnothing else in the library comes near it on these poses\n";
    return;
  }
  fmt::format_to(to, "\n{:<32} {:<11} {:>8} {:>9}  {}\n", "it could also be", "where", "p behind", "p right",
                 "possible");
  for (std::size_t i = 0; i < std::min(kAlternativesInText, all.size()); ++i) {
    const criticism::tests::Alternative& r = all[i];
    fmt::format_to(to, "{:<32} {:<11} {:>8.2g} {:>9.3f}  {}\n", r.effect, r.where, r.p_behind, r.p_right,
                   r.possible ? "yes" : "no");
  }
}

}  // namespace

json to_json(const Evidence& e) {
  json tells = json::array();
  for (const Evidence::Tell& tell : e.tells) tells.push_back({{"effect", tell.effect}, {"by", tell.by}});
  return {{"schema", "mgt.why/1"},
          {"candidate", to_json(e.candidate)},
          {"in_model", e.in_model},
          {"added_variable",
           {{"pose", e.added.pose},
            {"x", e.added.x},
            {"y", e.added.y},
            {"share", e.added.share},
            {"slope", number_or_null(e.added.slope)},
            {"slope_sd", number_or_null(e.added.slope_sd)}}},
          {"before", left_json(e.before)},
          {"after", left_json(e.after)},
          {"tells", std::move(tells)}};
}

std::string to_text(const Evidence& e) {
  const criticism::tests::Candidate& c = e.candidate;
  std::string out;
  const auto to = std::back_inserter(out);
  fmt::format_to(to, "{} at {}{}\n", c.effect, c.where,
                 e.in_model ? " (in the model; taken out to see it)" : "");
  fmt::format_to(to, "size       {}\n", size_text(c));
  fmt::format_to(to, "evidence   d = {:.1f}, {}, {} {}\n", c.d, stats::p_phrase(c.log10_p), c.k,
                 c.k == 1 ? "coefficient" : "coefficients");
  fmt::format_to(to, "residual   {:.3g} nT without it, {:.3g} nT with it; noise {:.3g} nT\n",
                 e.before.residual_nT, e.after.residual_nT, e.before.noise_nT);
  fmt::format_to(to, "chi-square {:.5g} without it, {:.5g} with it; predicted fall {:.4g}\n", e.before.chi2,
                 e.after.chi2, c.fall);
  if (c.impact && !c.impact->component.empty()) {
    fmt::format_to(to, "tensor     {:.3g} nT/m in {}, if the model goes without it\n", c.impact->nT_per_m,
                   c.impact->component);
  }
  tell_poses(c, out);
  tell_maps(e, out);
  tell_alternatives(e, out);
  if (!e.tells.empty()) out += "\nwhat would tell:\n";
  for (const Evidence::Tell& tell : e.tells) out += fmt::format("  {}\n    {}\n", tell.effect, tell.by);
  return out;
}

}  // namespace mgtd::calib::report
