// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>

#include "tests/accuracy/markdown.h"
#include "tests/blind/blind.h"
#include "tests/blind/page.h"

namespace mgtd::calib::testing {

using mgtd::testing::MarkdownTable;

std::string percent(int hits, int of) {
  if (of == 0) return "-";
  const Proportion p = proportion(hits, of);
  return fmt::format("{:.1f} ({:.1f}-{:.1f})", p.percent, p.low, p.high);
}

std::string clean_page(const Sizes& n) {
  MarkdownTable table({"noise", "runs", "not PASS, %", "EXPLAINED", "AMBIGUOUS", "PARTIAL", "UNKNOWN",
                       "BAD-DATA", "refused"});
  const std::array<std::pair<const char*, HiddenRun>, 6> kinds{
      {{"white", {}},
       {"white, size not told", {.spreads = false}},
       {"correlated 0.5 from pose to pose", {.rho = 0.5}},
       {"correlated 0.8", {.rho = 0.8}},
       {"Student t, 3 degrees of freedom", {.tail = Tail::student3}},
       {"three readings 15 sigma off", {.tail = Tail::outliers}}}};
  std::uint64_t seed = 10'000;
  for (const auto& [name, run] : kinds) {
    const Answers a = clean(run, n.clean, seed += 100'000);
    table.line({name, std::to_string(a.runs), percent(a.detected, a.runs),
                std::to_string(a.of(criticism::search::Finding::explained)),
                std::to_string(a.of(criticism::search::Finding::ambiguous)),
                std::to_string(a.of(criticism::search::Finding::partial)),
                std::to_string(a.of(criticism::search::Finding::unknown)),
                std::to_string(a.of(criticism::search::Finding::bad_data)), std::to_string(a.refused)});
    fmt::print(stderr, "clean: {}: {}\n", name, percent(a.detected, a.runs));
  }
  return "## Clean runs\n\nNothing is hidden; every verdict but PASS is a false alarm. Aim: 0.7 to 1.3 %, "
         "under 2 % in the last four lines.\n\n" +
         table.text();
}

}  // namespace mgtd::calib::testing
