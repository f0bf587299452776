// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "tests/blind/page.h"
#include "tests/blind/wandering_offsets.h"
#include "tests/discovery/answer.h"
#include "tests/discovery/pages.h"

namespace mgtd::calib::testing {
namespace {

using discovery::LawFinding;

struct Kind {
  const char* name;
  HiddenRun run;
  double step_nT{0};  ///< of the readings
  double walk_nT{0};  ///< of each offset from pose to pose
};

PoseTable clean_run(const Kind& kind, std::uint64_t seed) {
  HiddenRun run = kind.run;
  if (kind.walk_nT > 0) run.hidden = wandering_offsets({.step_nT = kind.walk_nT}, seed);
  PoseTable table = recorded_run(run, Course::swing, seed).table;
  for (Pose& pose : table.poses)
    for (Eigen::Vector3d& y_nT : pose.y_nT)
      if (kind.step_nT > 0) y_nT = kind.step_nT * (y_nT / kind.step_nT).array().round().matrix();
  return table;
}

}  // namespace

std::string clean_page(const Extent& extent) {
  const std::vector<Kind> kinds{
      {"white", {.noise_nT = kNoise_nT}},
      {"correlated from pose to pose, 0.3", {.noise_nT = kNoise_nT, .rho = 0.3}},
      {"correlated, 0.5", {.noise_nT = kNoise_nT, .rho = 0.5}},
      {"Student's t, three degrees of freedom", {.noise_nT = kNoise_nT, .tail = Tail::student3}},
      {"three readings off by 15 standard deviations", {.noise_nT = kNoise_nT, .tail = Tail::outliers}},
      {"readings in steps of 0.1 nT", {.noise_nT = kNoise_nT}, 0.1},
      {"every offset walks, 0.03 nT from pose to pose", {.noise_nT = kNoise_nT}, 0, 0.03}};
  std::string out =
      "## Nothing hidden\n\nShare of runs in which the whole search claims something at 1 %, and of those in "
      "which a formula is named (LAW or LAW-SET).\n\n| noise | runs | claimed, % | a formula named, % |\n"
      "|---|---|---|---|\n";
  AnswerFile<Answer> file(extent.answers);
  for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
    const int n = kind == 0 ? extent.clean : std::max(1, extent.clean / 4);
    const auto answers = cell(file, fmt::format("{}, {} draws", kinds[kind].name, extent.draws),
                              extent.first_seed + 10'000 * (kind + 1), n, [&](std::uint64_t seed) {
                                return ask(clean_run(kinds[kind], seed), nullptr, extent.draws);
                              });
    for (const Answer& a : answers)
      if (a.found)
        fmt::print(stderr, "{}: {} p {:.2f} {}\n", kinds[kind].name, discovery::to_string(a.finding),
                   a.log10_p, a.formula);
    const auto named = [](const Answer& a) {
      return a.finding == LawFinding::law || a.finding == LawFinding::law_set;
    };
    out += fmt::format("| {} | {} | {} | {} |\n", kinds[kind].name, n,
                       percent(count_of(answers, [](const Answer& a) { return a.found; }), n),
                       percent(count_of(answers, named), n));
  }
  return out + "\n";
}

}  // namespace mgtd::calib::testing
