// SPDX-License-Identifier: Apache-2.0
#include "calib/report/experiment_power_report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace mgtd::calib::report {
namespace {

using nlohmann::json;

std::string seen(const design::DesignPower& power) {
  std::string out = fmt::format("{:<34} {:>8} {:>8}  {:<13} {}\n", "effect that would be seen above",
                                "smallest", "sd", "unit", "where");
  for (const criticism::tests::Detectable& d : power.detectable) {
    if (d.value > 0)
      out +=
          fmt::format("  {:<32} {:>8.3g} {:>8.2g}  {:<13} {}\n", d.effect, d.value, d.sd(), d.unit, d.where);
    else
      out += fmt::format("  {:<32} at no size that occurs\n", d.effect);
  }
  return out;
}

std::string cure(const design::LookAlike& pair) {
  std::string out;
  if (pair.remedy)
    out = fmt::format("      {} ({:.0f} min): right in {:.0f} %\n", pair.remedy->action, pair.remedy->minutes,
                      100 * pair.remedy->p_right);
  if (!pair.advice.empty()) out += fmt::format("      {}\n", pair.advice);
  if (out.empty()) out = "      nothing on this rig separates them\n";
  return out;
}

std::string alike(const design::DesignPower& power) {
  if (power.inseparable.empty())
    return fmt::format("all {} pairs of effects can be told apart at {:.0f} standard errors\n", power.pairs,
                       design::kComparedAt_d);
  std::string out = fmt::format(
      "{} of {} pairs that cannot be told apart (named right in less than {:.0f} % at {:.0f} "
      "standard errors), and what would separate them\n",
      power.inseparable.size(), power.pairs, 100 * design::kSeparated, design::kComparedAt_d);
  for (const design::LookAlike& pair : power.inseparable) {
    out += fmt::format("  {} ({}) - {}: correlation {:.4f}, right in {:.0f} %\n", pair.effect, pair.where,
                       pair.alternative, pair.correlation, 100 * pair.p_right);
    out += cure(pair);
  }
  return out;
}

}  // namespace

void add_json(const design::DesignPower& power, json& report) {
  json detectable = json::array(), inseparable = json::array(), untestable = json::array();
  for (const criticism::tests::Detectable& d : power.detectable) {
    if (d.value > 0)
      detectable.push_back(
          {{"effect", d.effect}, {"where", d.where}, {"value", d.value}, {"sd", d.sd()}, {"unit", d.unit}});
    else
      untestable.push_back(
          {{"effect", d.effect}, {"why", "these poses would show it at no size that occurs"}});
  }
  for (const design::LookAlike& p : power.inseparable) {
    json remedy;
    if (p.remedy)
      remedy = {{"action", p.remedy->action}, {"minutes", p.remedy->minutes}, {"p_right", p.remedy->p_right}};
    inseparable.push_back({{"effect", p.effect},
                           {"where", p.where},
                           {"rival", p.alternative},
                           {"correlation", p.correlation},
                           {"p_right", p.p_right},
                           {"remedy", std::move(remedy)},
                           {"advice", p.advice}});
  }
  for (const criticism::tests::Untestable& u : power.untestable)
    untestable.push_back({{"effect", u.effect}, {"why", u.why}});
  report["detectable_above"] = std::move(detectable);
  report["inseparable"] = std::move(inseparable);
  report["pairs"] = power.pairs;
  report["untestable"] = std::move(untestable);
}

std::string to_text(const design::DesignPower& power) {
  std::string out = seen(power) + "\n" + alike(power);
  if (power.untestable.empty()) return out;
  out += "\nnot testable by this run\n";
  for (const criticism::tests::Untestable& u : power.untestable)
    out += fmt::format("  {:<32}{}\n", u.effect, u.why);
  return out;
}

}  // namespace mgtd::calib::report
