// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/library/effect_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace mgtd::calib::effects::library {
namespace {

constexpr std::size_t kWidth = 100, kIndent = 14;

/// A labelled paragraph, broken at blanks.
std::string paragraph(std::string_view label, std::string_view text) {
  std::string out = fmt::format("{:<{}}", label, kIndent);
  std::size_t column = kIndent;
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find(' '));
    text.remove_prefix(std::min(word.size() + 1, text.size()));
    if (column > kIndent && column + word.size() + 1 > kWidth) {
      out += fmt::format("\n{:{}}", "", kIndent);
      column = kIndent;
    } else if (column > kIndent) {
      out += ' ', ++column;
    }
    out += word;
    column += word.size();
  }
  return out + "\n";
}

/// Of its first coefficient; a current without a column has none yet.
std::string unit_of(const EffectFamily& family) {
  const auto effect =
      make_effect(family.name == "platform.current"           ? "platform.current,columns=motor_A"
                  : family.name == "platform.tabletop-magnet" ? "platform.tabletop-magnet,mounts=1/2"
                                                              : family.name);
  return (*effect)->coefficients().front().unit;
}

std::string example_of(const EffectFamily& family) {
  std::string out(family.name);
  if (family.scales.front() == Where::Scale::each_axis) out += "@s3.z";
  return out;
}

std::string scan_text(const Scan& scan) {
  if (scan.range == Scan::Range::run)
    return fmt::format("{} in {}: {} times between poses, through the run", scan.parameter, scan.unit,
                       scan.steps);
  return fmt::format("{} from {:g} to {:g}{}{}, {} values{}", scan.parameter, scan.from, scan.to,
                     scan.unit.empty() ? "" : " ", scan.unit, scan.steps,
                     scan.range == Scan::Range::logarithmic ? " in equal ratios" : "");
}

std::vector<std::string> scale_names(const EffectFamily& family) {
  std::vector<std::string> out;
  for (const Where::Scale scale : family.scales) {
    const Where where{.scale = scale, .sensor = 2, .axis = scale == Where::Scale::axis ? 2 : -1};
    out.push_back(scale == Where::Scale::own ? std::string(to_string(family.level)) : where.text());
  }
  return out;
}

}  // namespace

std::string effect_list() {
  std::string out;
  for (const EffectFamily& family : effect_families()) {
    out += fmt::format("{:<33} {}{}\n", family.name, family.title,
                       family.untestable.empty() ? "" : " (no residual can show it)");
  }
  return out + "\nmgt effects NAME tells cause, formula, size, signature and what looks alike.\n";
}

std::string effect_page(const EffectFamily& family) {
  std::string out = fmt::format("{}: {}\n\n", family.name, family.title);
  out += paragraph("cause", family.cause);
  out += paragraph("formula", family.equation);
  out += paragraph("coefficients", family.coefficients);
  if (family.scan) out += paragraph("searched", scan_text(*family.scan));
  out +=
      paragraph("size", fmt::format("typically {:g} {}: {}", family.typical, unit_of(family), family.source));
  out += paragraph("signature", family.signature);
  out += paragraph("needs", family.needs.empty() ? "nothing beyond the readings" : family.needs);
  if (!family.untestable.empty()) out += paragraph("untestable", family.untestable);
  if (!family.experiment.empty()) out += paragraph("experiment", family.experiment);
  for (const Confusion& c : family.confusions)
    out += paragraph("looks like", fmt::format("{}. Told apart by: {}", c.with, c.broken_by));
  if (family.untestable.empty()) {
    out += paragraph("laid over", fmt::format("{}", fmt::join(scale_names(family), ", ")));
    out += paragraph("use", fmt::format("mgt fit RUN --with {}", example_of(family)));
  }
  return out;
}

nlohmann::json effects_json(std::span<const EffectFamily> families) {
  using nlohmann::json;
  json list = json::array();
  for (const EffectFamily& f : families) {
    json confusions = json::array();
    for (const Confusion& c : f.confusions)
      confusions.push_back({{"with", c.with}, {"broken_by", c.broken_by}});
    json entry{{"effect", f.name},
               {"level", to_string(f.level)},
               {"title", f.title},
               {"cause", f.cause},
               {"equation", f.equation},
               {"coefficients", f.coefficients},
               {"unit", unit_of(f)},
               {"typical", f.typical},
               {"bound", f.bound},
               {"source", f.source},
               {"needs", f.needs},
               {"signature", f.signature},
               {"where", scale_names(f)},
               {"confusions", std::move(confusions)},
               {"untestable", f.untestable.empty() ? json() : json(f.untestable)},
               {"experiment", f.experiment.empty() ? json() : json(f.experiment)},
               {"scan", json()}};
    if (f.scan) {
      entry["scan"] = {{"parameter", f.scan->parameter},
                       {"unit", f.scan->unit},
                       {"from", f.scan->from},
                       {"to", f.scan->to},
                       {"steps", f.scan->steps}};
    }
    list.push_back(std::move(entry));
  }
  return {{"schema", "mgt.effects/1"}, {"effects", std::move(list)}};
}

}  // namespace mgtd::calib::effects::library
