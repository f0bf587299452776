// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "calib/stats/chi_square.h"
#include "tests/accuracy/markdown.h"
#include "tests/blind/campaign.h"
#include "tests/blind/page.h"
#include "tests/blind/real_answer.h"
#include "tests/rig/pose_writer.h"

namespace mgtd::calib::testing {
namespace {

using mgtd::testing::MarkdownTable;
using RealAnswers = std::vector<RealAnswer>;

constexpr const char* kAboutRealNoise = R"(## Real noise

What happens outside the laboratory, {0} runs of each kind, written by

    blind --only real-noise --runs {0}{1} -o page.md

The runs come from the simulated rig (`tests/rig`), whose physics shares no code with the estimator: samples at 50 Hz with 0.3 nT of noise, dwells of 4 and 8 s, 24 of 157 poses visited again, table angles to 0.1 degrees, temperatures up and down by 3 degrees, a switched motor and a battery beside the table. Each is fitted and explained, and told nothing. Names that a formula takes the place of are taken back, as by `mgt explain`.

- `must`. PASS: accepted, PASS and no name. no name: accepted, and no name. name: EXPLAINED by right names, or AMBIGUOUS with one among the possible. open: something is there, and no wrong name is given. set aside: accepted, no wrong name, and the disturbed poses cost the calibration less than 20 %. refuse: not accepted by fit, and BAD-DATA or refused by explain. agree: accepted and PASS, or neither.
- `tensor`: median error of the calibrated tensor of a uniform field of 50 000 nT over all attitudes, as fitted, at 0.4 m. `over the plain rig`: median and worst of that error after explain, over the error from the same run with white noise and nothing hidden.
- NEES: mean normalised error squared by the covariance that fit states, and the band where 95 % of such means lie when it is the real one. The rotation that all sensors share is taken out exactly and counts by itself. Offsets that wander are those of the last dwell, as the stated ones are.
- CPU: fit and explain, mean of a run; the only column that is another each time.

Sizes: 1/f noise of 6 pT/sqrt(Hz) at 1 Hz is that of a good fluxgate (5 is reported of a single-board one, J. Appl. Phys. 135, 034501, 2024), 20 the upper end of basic ones; the temperature laws are those measured of the four fluxgates 687 to 690 of the AUV Sentry (`tests/rig/data/README.md`); 0.3 and 1 nT/sqrt(h) spread by the 0.1 to 5 nT in an hour that offsets are said to drift. Aim: a wrong name in less than 2 % of every kind, a wrong single name in less than 1 %.

)";

constexpr const char* kAboutSite = R"(## Effects of the site

A gradient, a curvature, a dipole 1 to 2 m away, a gradient that steps, and iron that passes 2 to 3 m away at 3 cm/s, of random direction, each as large as `d` of its own Cramér-Rao uncertainties; {0} runs of each from the simulated rig, written by

    blind --only site --runs {0}{1} -o page.md

Right names of the step: site.step and site.gradient-drift, which may be a step; of the passing iron: site.transient and site.dipole, or no name and the disturbed poses left out.

)";

/// Of runs that are all of the same length, on stderr.
class Progress {
 public:
  explicit Progress(int runs) : runs_(runs) {}
  void known() { --runs_; }
  void done(const std::string& what) {
    ++done_;
    const std::chrono::duration<double> since = std::chrono::steady_clock::now() - begin_;
    if (since.count() < next_s_ && done_ < runs_) return;
    next_s_ = since.count() + 10;
    fmt::print(stderr, "real noise: {} of {} ({}), {:.0f} s left\n", done_, runs_, what,
               since.count() / done_ * (runs_ - done_));
  }

 private:
  int runs_, done_{0};
  double next_s_{0};
  std::chrono::steady_clock::time_point begin_{std::chrono::steady_clock::now()};
};

void keep(const std::string& folder, const std::string& name, const PoseTable& table) {
  std::filesystem::create_directories(folder);
  std::ofstream(folder + "/" + name + ".csv") << rig::pose_table_csv(table);
}

RealAnswers ask(const RealKind& kind, const Sizes& n, AnswerFile<RealAnswer>& file, Progress& progress) {
  for (int i = 0; i < n.real; ++i)
    if (file.find(kind.name, n.first_seed + static_cast<std::uint64_t>(i)) != nullptr) progress.known();
  return campaign(
      file, kind.name, n.first_seed, n.real,
      [&](std::uint64_t seed) { return answer_to(kind.make(seed), kind.parameters); },
      [&](std::uint64_t seed, const RealAnswer& answer) {
        progress.done(kind.name);
        if (answer.good(kind)) return;
        fmt::print(stderr, "{} seed {}: {}\n", kind.name, seed, told(answer));
        if (!n.keep.empty()) keep(n.keep, fmt::format("{}-{}", kind.name, seed), kind.make(seed).table);
      });
}

template <class Is>
int count(const RealAnswers& answers, Is is) {
  return static_cast<int>(std::count_if(answers.begin(), answers.end(), is));
}

template <class Value>
std::vector<double> values(const RealAnswers& answers, Value value) {
  std::vector<double> out;
  for (const RealAnswer& a : answers)
    if (const std::optional<double> v = value(a)) out.push_back(*v);
  std::sort(out.begin(), out.end());
  return out;
}

std::string median(const std::vector<double>& sorted) {
  return sorted.empty() ? "-" : fmt::format("{:.3g}", sorted[sorted.size() / 2]);
}

/// Mean over the runs, and where 95 % of such means lie when the covariance is the real one.
std::string nees(const std::vector<double>& of, double dof) {
  if (of.empty()) return "-";
  const auto n = static_cast<double>(of.size());
  double mean = 0;
  for (const double v : of) mean += v / n;
  return fmt::format("{:.1f} ({:.1f}-{:.1f})", mean, stats::chi_square_limit(0.975, n * dof) / n,
                     stats::chi_square_limit(0.025, n * dof) / n);
}

std::string verdicts(const RealAnswers& answers) {
  std::string out;
  const auto add = [&](int n, std::string_view what) {
    if (n > 0) out += fmt::format("{}{} {}", out.empty() ? "" : ", ", what, n);
  };
  for (const criticism::search::Finding f :
       {criticism::search::Finding::pass, criticism::search::Finding::explained,
        criticism::search::Finding::ambiguous, criticism::search::Finding::partial,
        criticism::search::Finding::unknown, criticism::search::Finding::bad_data})
    add(count(answers, [f](const RealAnswer& a) { return !a.explain_refused && a.finding == f; }),
        to_string(f));
  add(count(answers, [](const RealAnswer& a) { return a.explain_refused; }), "refused");
  return out;
}

std::string must_text(const RealKind& kind) {
  switch (kind.must) {
    case Must::pass:
      return "PASS";
    case Must::no_name:
      return "no name";
    case Must::name:
      return "name";
    case Must::open:
      return "open";
    case Must::set_aside:
      return "set aside";
    case Must::refuse:
      return "refuse";
    case Must::agree:
      return "agree";
  }
  return "";
}

std::vector<std::string> noise_line(const RealKind& kind, const RealAnswers& all) {
  const int runs = static_cast<int>(all.size());
  const auto over = values(all, [&](const RealAnswer& a) -> std::optional<double> {
    if (!kind.tensor || !a.error_after_nT_per_m || !a.plain_nT_per_m) return std::nullopt;
    return a.over_plain();
  });
  double cpu_s = 0;
  for (const RealAnswer& a : all) cpu_s += a.cpu_s / runs;
  return {kind.what,
          must_text(kind),
          percent(count(all, [&](const RealAnswer& a) { return a.good(kind); }), runs),
          verdicts(all),
          percent(count(all, [&](const RealAnswer& a) { return a.wrong_name(kind); }), runs),
          percent(count(all, [&](const RealAnswer& a) { return a.wrong_single(kind); }), runs),
          percent(count(all, [](const RealAnswer& a) { return a.accepted; }), runs),
          kind.tensor ? median(values(all, [](const RealAnswer& a) { return a.error_nT_per_m; })) : "-",
          median(over),
          over.empty() ? "-" : fmt::format("{:.3g}", over.back()),
          nees(values(all, [](const RealAnswer& a) { return a.nees_scales; }), kScales),
          nees(values(all, [](const RealAnswer& a) { return a.nees_offsets; }), kOffsets),
          fmt::format("{:.2f}", cpu_s)};
}

std::vector<std::string> site_line(const RealKind& kind, const RealAnswers& all) {
  const int runs = static_cast<int>(all.size());
  // What comes and goes is answered rightly by leaving out the poses it disturbs, too.
  const bool goes = std::find(kind.right.begin(), kind.right.end(), "site.transient") != kind.right.end();
  const auto set_aside = [&](const RealAnswer& a) { return goes && a.left_out && !a.named_any(); };
  const auto said = [&](const RealAnswer& a) {
    return !a.explain_refused && (a.finding != criticism::search::Finding::pass || set_aside(a));
  };
  const int detected = count(all, said);
  const auto right = [&](const std::vector<std::string>& names) {
    return std::any_of(names.begin(), names.end(), [&](const std::string& name) {
      return std::find(kind.right.begin(), kind.right.end(), name) != kind.right.end();
    });
  };
  return {
      kind.what,
      fmt::format("{:.0f}", kind.d),
      percent(detected, runs),
      percent(count(all,
                    [&](const RealAnswer& a) {
                      return said(a) && (set_aside(a) || (a.named_any() && right({a.named.front()})));
                    }),
              detected),
      percent(count(all, [&](const RealAnswer& a) { return said(a) && (set_aside(a) || right(a.declared)); }),
              detected),
      percent(count(all, [&](const RealAnswer& a) { return a.wrong_single(kind); }), runs),
      verdicts(all)};
}

/// The option that the page was written with, where it is not the default.
std::string seeds(const Sizes& n) {
  return n.first_seed == Sizes{}.first_seed ? "" : fmt::format(" --first-seed {}", n.first_seed);
}

std::vector<RealKind> chosen(const std::vector<RealKind>& all, const std::vector<std::string>& names) {
  std::vector<RealKind> out;
  for (const RealKind& kind : all) {
    const bool wanted = std::any_of(names.begin(), names.end(),
                                    [&](const std::string& name) { return is_called(kind, name); });
    if (names.empty() || wanted) out.push_back(kind);
  }
  return out;
}

template <class Line>
std::string table_of(const std::vector<std::string>& header, const std::vector<RealKind>& kinds,
                     const Sizes& n, Line line) {
  if (kinds.empty()) return "";
  MarkdownTable table(header);
  AnswerFile<RealAnswer> file(n.answers);
  Progress progress(n.real * static_cast<int>(kinds.size()));
  for (const RealKind& kind : kinds) {
    const auto cells = line(kind, ask(kind, n, file, progress));
    fmt::print(stderr, "{}: {}\n", kind.name, fmt::join(cells, " | "));
    table.line(cells);
  }
  return table.text();
}

}  // namespace

std::string real_noise_page(const Sizes& n) {
  const std::string table =
      table_of({"run", "must", "as it must be, %", "verdicts", "a wrong name, %", "wrong single name, %",
                "accepted, %", "tensor, nT/m", "over the plain rig", "worst", "NEES of 36 scales and angles",
                "of 12 offsets", "CPU, s"},
               chosen(real_kinds(), n.kinds), n, &noise_line);
  if (table.empty()) return "";
  return fmt::format(kAboutRealNoise, n.real, seeds(n)) + table;
}

std::string site_page(const Sizes& n) {
  const std::string table = table_of({"at the site", "d", "detected, %", "right name first, %",
                                      "right name in the set, %", "wrong single name, %", "verdicts"},
                                     chosen(site_kinds(), n.kinds), n, &site_line);
  if (table.empty()) return "";
  return fmt::format(kAboutSite, n.real, seeds(n)) + table;
}

}  // namespace mgtd::calib::testing
