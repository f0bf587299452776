// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "tests/blind/page.h"
#include "tests/discovery/answer.h"
#include "tests/discovery/pages.h"

namespace mgtd::calib::testing {

std::string lawless_page(const Extent& extent) {
  const int runs = extent.runs;
  using discovery::LawFinding;
  std::string out =
      "## What is no formula of the grammar\n\nOn s3.z. No formula may be called the law.\n\n| hidden | d | "
      "found, % | on s3.z, % | LAW, % | LAW-SET, % | SHAPE-ONLY, % | NOISE-LIKE, % "
      "|\n|---|---|---|---|---|---|---|---|\n";
  int all = 0, named = 0;
  AnswerFile<Answer> file(extent.answers);
  for (std::size_t l = 0; l < lawless().size(); ++l) {
    for (const int d : {20, 40}) {
      const auto answers =
          cell(file, fmt::format("{}, d = {}, {} draws", lawless()[l].name, d, extent.draws),
               extent.first_seed + 500'000 + 1000 * l + 17 * static_cast<std::uint64_t>(d), runs,
               [&](std::uint64_t seed) { return ask_of_lawless(lawless()[l], d, seed, extent.draws); });
      const auto said = [&](LawFinding v) {
        return percent(count_of(answers, [v](const Answer& a) { return a.finding == v; }), runs);
      };
      for (const Answer& a : answers)
        if (a.finding != LawFinding::noise_like)
          fmt::print(stderr, "{} d {}: {} P {:.2f} {}; {}\n", lawless()[l].name, d,
                     discovery::to_string(a.finding), a.P, a.formula, a.reason);
      all += runs;
      named += count_of(answers, [](const Answer& a) { return a.finding == LawFinding::law; });
      out += fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} |\n", lawless()[l].name, d,
                         percent(count_of(answers, [](const Answer& a) { return a.found; }), runs),
                         percent(count_of(answers, [](const Answer& a) { return a.place; }), runs),
                         said(LawFinding::law), said(LawFinding::law_set), said(LawFinding::shape_only),
                         said(LawFinding::noise_like));
    }
  }
  return out + fmt::format("\nLAW in {} % of all {} runs.\n\n", percent(named, all), all);
}

}  // namespace mgtd::calib::testing
