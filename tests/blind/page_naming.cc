// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "tests/accuracy/markdown.h"
#include "tests/blind/blind.h"
#include "tests/blind/page.h"

namespace mgtd::calib::testing {
namespace {

using mgtd::testing::MarkdownTable;

int median(std::vector<int> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::vector<std::string> naming_line(std::string name, double d, const Answers& a) {
  return {
      std::move(name),
      fmt::format("{:.0f}", d),
      percent(a.detected, a.runs),
      percent(a.named_first, a.detected),
      a.detected > 0 ? fmt::format("{:.1f}", 100 * a.told_at_best / a.detected) : "-",
      percent(a.in_set, a.detected),
      std::to_string(median(a.set_sizes)),
      percent(a.wrong_single, a.runs),
      percent(a.of(criticism::search::Finding::partial) + a.of(criticism::search::Finding::unknown), a.runs)};
}

/// At one field strength no residual tells these two apart.
bool inseparable(const HiddenLaw& law) { return law.name == "axis.quadratic"; }

using Confusions = std::map<std::string, std::map<std::string, int>>;

std::string confusion_text(const Confusions& confusions, int runs) {
  std::string out;
  for (const auto& [truth, first] : confusions) {
    std::string line;
    for (const auto& [name, count] : first)
      line += fmt::format("{}{} {}", line.empty() ? "" : ", ", name, count);
    out += fmt::format("- {}: {} (of {})\n", truth, line, runs);
  }
  return out;
}

}  // namespace

std::string naming_page(const Sizes& n) {
  const std::vector<std::string> header{
      "hidden on one axis",       "d",     "detected, %",          "right name first, %",  "at best, %",
      "right name in the set, %", "names", "wrong single name, %", "PARTIAL or UNKNOWN, %"};
  MarkdownTable all(header), each(header);
  Confusions confusions;
  std::uint64_t seed = 5'000'000;
  for (const double d : {5.0, 6.0, 8.0, 10.0, 15.0, 40.0}) {
    Answers sum;
    for (const HiddenLaw& law : hidden_laws()) {
      const Answers a = hidden(law, d, n.runs, seed += 10'000);
      if (!inseparable(law)) sum += a;
      each.line(naming_line(std::string(law.name), d, a));
      if (d == 15) confusions[std::string(law.name)] = a.first;
      fmt::print(stderr, "hidden: d = {} {}: {}, {}, {}\n", d, law.name, percent(a.detected, a.runs),
                 percent(a.named_first, a.detected), percent(a.in_set, a.detected));
    }
    all.line(naming_line("all but the quadratic", d, sum));
  }
  return "## One law of the library, hidden on one axis\n\n`d` is its size in units of its own Cramér-Rao "
         "uncertainty. The set: names that are named or declared possible; `names` its median size. The "
         "quadratic, "
         "which one field strength does not tell from the squares of the transverse axes, is not in the sum. "
         "`at best`: mean chance that the right one of two laws wins, the first name and the one that is "
         "hardest to tell from it at the size that was found; noise alone allows no more. Aim: detected 60, "
         "88, 99 % at d = 5, 6, 8; right name first 95, 98, 99.5 % at 8, 10, 15; in the "
         "set "
         "99.5 % from 8; wrong single name under 1 %.\n\n" +
         all.text() + "Named first at d = 15:\n\n" + confusion_text(confusions, n.runs) + "\n" + each.text();
}

std::string one_field_page(const Sizes& n) {
  MarkdownTable table({"hidden on one axis", "d", "AMBIGUOUS, %", "right name in the set, %",
                       "first advice is another field, %", "EXPLAINED, %"});
  std::uint64_t seed = 70'000'000;
  for (const HiddenLaw& law : one_field_laws()) {
    for (const double d : {10.0, 20.0, 40.0}) {
      const Answers a = hidden(law, d, n.runs, seed += 10'000);
      table.line({std::string(law.name) + (law.name == "axis.transverse" ? ", squares" : ""),
                  fmt::format("{:.0f}", d), percent(a.of(criticism::search::Finding::ambiguous), a.runs),
                  percent(a.in_set, a.runs), percent(a.advised, a.runs),
                  percent(a.of(criticism::search::Finding::explained), a.runs)});
      fmt::print(stderr, "one field: {} {}\n", law.name,
                 percent(a.of(criticism::search::Finding::ambiguous), a.runs));
    }
  }
  return "## Own square or transverse squares, one field strength\n\nNothing but their idealised forms would "
         "decide. "
         "Aim: AMBIGUOUS in 100 %, with the advice to change the field.\n\n" +
         table.text();
}

std::string open_page(const Sizes& n) {
  MarkdownTable table({"hidden on one axis", "d", "detected, %", "UNKNOWN or PARTIAL, %",
                       "PASS, an offset that wanders, %", "EXPLAINED, %", "most named"});
  const auto line = [&](std::string_view title, double d, const Answers& a, const std::string& most) {
    const std::string open = percent(
        a.of(criticism::search::Finding::unknown) + a.of(criticism::search::Finding::partial), a.runs);
    table.line({std::string(title), fmt::format("{:.0f}", d), percent(a.detected, a.runs), open,
                percent(a.wanders, a.runs), percent(a.of(criticism::search::Finding::explained), a.runs),
                most});
    fmt::print(stderr, "open: d = {} {}: {}\n", d, title, open);
  };
  std::uint64_t seed = 90'000'000;
  for (const double d : {20.0, 40.0}) {
    std::array<Answers, 2> sum;
    const auto add = [&](const HiddenLaw& law, bool taken_out) {
      const Answers a = hidden(law, d, n.runs, seed += 10'000, taken_out);
      sum.at(taken_out ? 1 : 0) += a;
      const auto most = std::max_element(a.first.begin(), a.first.end(),
                                         [](const auto& x, const auto& y) { return x.second < y.second; });
      line(law.name, d, a, most == a.first.end() ? "-" : most->first);
    };
    for (const HiddenLaw& law : unlisted_laws()) add(law, false);
    for (const HiddenLaw& law : hidden_laws())
      if (!inseparable(law)) add(law, true);
    line("all that were never in it", d, sum[0], "");
    line("all that were taken out", d, sum[1], "");
  }
  return "## What is in no library\n\nLaws that were never in it, and laws of the library with the library's "
         "own entry taken out. What makes one offset move slowly is an offset that wanders, for all that one "
         "run can tell, and explain says so with its size and without a name. Aim: UNKNOWN, PARTIAL or that "
         "in 80 % at d = 20, 97 % at 40.\n\n" +
         table.text();
}

std::string two_page(const Sizes& n) {
  MarkdownTable table({"d of both", "runs", "both added, %", "both added or declared possible, %",
                       "something else added, %", "missed"});
  std::uint64_t seed = 110'000'000;
  for (const double d : {15.0, 40.0}) {
    const TwoAnswers a = two_hidden(d, 4 * n.runs, seed += 100'000);
    std::string missed;
    for (const auto& [name, count] : a.missed)
      missed += fmt::format("{}{} {}", missed.empty() ? "" : ", ", name, count);
    table.line({fmt::format("{:.0f}", d), std::to_string(a.runs), percent(a.both_added, a.runs),
                percent(a.both_found, a.runs), percent(a.wrong_added, a.runs), missed});
    fmt::print(stderr, "two: d = {}: {} {} missed {}\n", d, percent(a.both_added, a.runs),
               percent(a.both_found, a.runs), missed);
  }
  return "## Two laws at once\n\nOf different names, on two axes, both drawn at random; `improve`. Aim: both "
         "found in 90 % at d = 15, 98 % at 40.\n\n" +
         table.text();
}

}  // namespace mgtd::calib::testing
