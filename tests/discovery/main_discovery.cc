// SPDX-License-Identifier: Apache-2.0
// Writes docs/discovery-benchmark.md: laws of no library are hidden in simulated runs, discover is asked, its
// answers are counted.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <fstream>
#include <mutex>
#include <nlohmann/json.hpp>
#include <regex>
#include <thread>

#include "calib/discovery/discover.h"
#include "calib/report/discovery_reason.h"
#include "tests/blind/page.h"
#include "tests/discovery/unknown_law.h"

namespace mgtd::calib::testing {
namespace {

using discovery::DiscoveryReport;
using discovery::LawFinding;

constexpr double kNoise_nT = 0.05;

/// What was said of one run.
struct Answer {
  LawFinding verdict{LawFinding::pass};
  double log10_p{0}, P{0};
  bool found{false}, place{false}, covariate{false}, first{false}, in_set{false}, alike{false};
  std::size_t set{0};
  std::string formula{}, reason{};
};

bool is_true(const UnknownLaw& law, const discovery::FoundFormula& f) {
  return f.where == "s3.z" && std::regex_match(f.formula, std::regex(law.truth));
}

Answer ask(const PoseTable& table, const UnknownLaw* law, int draws) {
  const auto found = discovery::discover(table, {.fit = {}, .draws = draws, .checks = false});
  if (!found) throw std::runtime_error(found.error().text());
  const discovery::FoundLaw& first = found->laws.front();
  Answer out{.verdict = found->verdict, .log10_p = first.log10_p};
  out.found = first.log10_p < -2;
  out.P = first.formulas.front().P;
  out.formula = first.formulas.front().formula + " at " + first.formulas.front().where;
  out.set = first.formulas.size() + first.more;
  out.reason = report::reason_text(*found);
  out.place = first.where.front().name == "s3.z";
  if (law == nullptr) return out;
  out.covariate = first.covariates.front().name == law->covariate;
  out.first = is_true(*law, first.formulas.front());
  for (const discovery::FoundFormula& f : first.formulas) {
    if (!is_true(*law, f)) continue;
    out.in_set = true;
    out.alike = out.alike || f.same_as == first.formulas.front().same_as;
  }
  return out;
}

/// Runs `count` of something on two threads, in order.
template <class Make>
std::vector<Answer> campaign(int count, const Make& make) {
  std::vector<Answer> out(static_cast<std::size_t>(count));
  std::atomic<int> next{0};
  const auto work = [&] {
    for (int i = next++; i < count; i = next++) out[static_cast<std::size_t>(i)] = make(i);
  };
  std::thread other(work);
  work();
  other.join();
  return out;
}

template <class Is>
int count_of(const std::vector<Answer>& all, const Is& is) {
  return static_cast<int>(std::count_if(all.begin(), all.end(), is));
}

std::string clean_page(int runs, int draws) {
  std::string out =
      "## Nothing hidden\n\nShare of runs in which the whole search claims something at 1 %, and of those "
      "the "
      "verdict that named a formula (LAW or LAW-SET).\n\n| noise | runs | claimed, % | a formula named, % |\n"
      "|---|---|---|---|\n";
  struct Kind {
    const char* name;
    HiddenRun run;
  };
  const std::vector<Kind> kinds{
      {"white", {.noise_nT = kNoise_nT}},
      {"correlated from pose to pose, 0.3", {.noise_nT = kNoise_nT, .rho = 0.3}},
      {"correlated, 0.5", {.noise_nT = kNoise_nT, .rho = 0.5}},
      {"Student's t, three degrees of freedom", {.noise_nT = kNoise_nT, .tail = Tail::student3}},
      {"three readings off by 15 standard deviations", {.noise_nT = kNoise_nT, .tail = Tail::outliers}}};
  for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
    const int n = kind == 0 ? runs : std::max(1, runs / 4);
    const auto answers = campaign(n, [&](int i) {
      return ask(law_run({.noise = kinds[kind].run}, 1000 * (kind + 1) + static_cast<std::uint64_t>(i)),
                 nullptr, draws);
    });
    for (const Answer& a : answers)
      if (a.found)
        fmt::print(stderr, "{}: {} p {:.2f} {}\n", kinds[kind].name, discovery::to_string(a.verdict),
                   a.log10_p, a.formula);
    out += fmt::format("| {} | {} | {} | {} |\n", kinds[kind].name, n,
                       percent(count_of(answers, [](const Answer& a) { return a.found; }), n),
                       percent(count_of(answers,
                                        [](const Answer& a) {
                                          return a.verdict == LawFinding::law ||
                                                 a.verdict == LawFinding::law_set;
                                        }),
                               n));
  }
  return out + "\n";
}

std::string laws_page(int runs, int draws) {
  std::string out =
      "## Laws of the grammar\n\nEach on s3.z, with numbers drawn anew in every run; d is the length of the "
      "law in "
      "standard deviations before the calibration takes its part. *First*: the formula that leads is the one "
      "that "
      "was hidden. *Or alike*: or one that these poses do not tell from it. *LAW wrong*: the verdict was LAW "
      "and "
      "the formula another.\n\n";
  struct Sum {
    int n{0}, found{0}, place{0}, covariate{0}, first{0}, alike{0}, set{0}, law{0}, law_wrong{0}, sure{0},
        sure_wrong{0};
  };
  std::string head =
      "| law | d | found, % | place, % | covariate, % | first, % | or alike, % | in the 99 % set, % | size "
      "of the set, median | verdict LAW, % |\n|---|---|---|---|---|---|---|---|---|---|\n";
  out += head;
  std::map<int, Sum> sums;
  for (std::size_t l = 0; l < unknown_laws().size(); ++l) {
    const UnknownLaw& law = unknown_laws()[l];
    for (const int d : {10, 20, 40}) {
      const auto answers = campaign(runs, [&](int i) {
        const std::uint64_t seed =
            100'000 + 1000 * l + static_cast<std::uint64_t>(i) + 17 * static_cast<std::uint64_t>(d);
        std::mt19937_64 rng(seed);
        return ask(
            law_run({.noise = {.noise_nT = kNoise_nT}, .law = law.draw(rng), .d = static_cast<double>(d)},
                    seed),
            &law, draws);
      });
      Sum& s = sums[d];
      std::vector<std::size_t> sets;
      const auto percent_of = [&](auto is, int Sum::*sum) {
        const int hits = count_of(answers, is);
        s.*sum += hits;
        return percent(hits, runs);
      };
      for (const Answer& a : answers) {
        sets.push_back(a.set);
        const bool right = a.first || a.alike;
        s.law_wrong += a.verdict == LawFinding::law && !right ? 1 : 0;
        s.sure += a.P > 0.99 ? 1 : 0, s.sure_wrong += a.P > 0.99 && !right ? 1 : 0;
        if (!a.first || a.verdict != LawFinding::law)
          fmt::print(stderr, "{} d {}: {} P {:.2f} {}{}; {}\n", law.name, d, discovery::to_string(a.verdict),
                     a.P, a.formula, a.in_set ? "" : " (not in set)", a.reason);
      }
      s.n += runs;
      std::nth_element(sets.begin(), sets.begin() + static_cast<std::ptrdiff_t>(sets.size() / 2), sets.end());
      out +=
          fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", law.name, d,
                      percent_of([](const Answer& a) { return a.found; }, &Sum::found),
                      percent_of([](const Answer& a) { return a.place; }, &Sum::place),
                      percent_of([](const Answer& a) { return a.covariate; }, &Sum::covariate),
                      percent_of([](const Answer& a) { return a.first; }, &Sum::first),
                      percent_of([](const Answer& a) { return a.first || a.alike; }, &Sum::alike),
                      percent_of([](const Answer& a) { return a.in_set; }, &Sum::set), sets[sets.size() / 2],
                      percent_of([](const Answer& a) { return a.verdict == LawFinding::law; }, &Sum::law));
    }
  }
  out +=
      "\n| all laws, d | runs | found, % | place, % | covariate, % | first, % | or alike, % | in the 99 % "
      "set, % | LAW wrong, % | P above 0.99 and wrong, % |\n|---|---|---|---|---|---|---|---|---|---|\n";
  for (const auto& [d, s] : sums)
    out += fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", d, s.n, percent(s.found, s.n),
                       percent(s.place, s.n), percent(s.covariate, s.n), percent(s.first, s.n),
                       percent(s.alike, s.n), percent(s.set, s.n), percent(s.law_wrong, s.n),
                       percent(s.sure_wrong, s.sure));
  return out + "\n";
}

std::string lawless_page(int runs, int draws) {
  std::string out =
      "## What is no formula of the grammar\n\nOn s3.z. No formula may be called the law.\n\n| hidden | d | "
      "found, % | on s3.z, % | LAW, % | LAW-SET, % | SHAPE-ONLY, % | NOISE-LIKE, % "
      "|\n|---|---|---|---|---|---|---|---|\n";
  for (std::size_t l = 0; l < lawless().size(); ++l) {
    for (const int d : {20, 40}) {
      const auto answers = campaign(runs, [&](int i) {
        const std::uint64_t seed =
            500'000 + 1000 * l + static_cast<std::uint64_t>(i) + 17 * static_cast<std::uint64_t>(d);
        std::mt19937_64 rng(seed);
        return ask(law_run({.noise = {.noise_nT = kNoise_nT},
                            .law = lawless()[l].draw(rng),
                            .d = static_cast<double>(d)},
                           seed),
                   nullptr, draws);
      });
      const auto said = [&](LawFinding v) {
        return percent(count_of(answers, [v](const Answer& a) { return a.verdict == v; }), runs);
      };
      for (const Answer& a : answers)
        if (a.verdict != LawFinding::noise_like)
          fmt::print(stderr, "{} d {}: {} P {:.2f} {}; {}\n", lawless()[l].name, d,
                     discovery::to_string(a.verdict), a.P, a.formula, a.reason);
      out += fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} |\n", lawless()[l].name, d,
                         percent(count_of(answers, [](const Answer& a) { return a.found; }), runs),
                         percent(count_of(answers, [](const Answer& a) { return a.place; }), runs),
                         said(LawFinding::law), said(LawFinding::law_set), said(LawFinding::shape_only),
                         said(LawFinding::noise_like));
    }
  }
  return out + "\n";
}

}  // namespace
}  // namespace mgtd::calib::testing

int main(int argc, char** argv) {
  using namespace mgtd::calib::testing;
  CLI::App app{"writes docs/discovery-benchmark.md"};
  int clean = 1000, runs = 60, draws = 2000;
  std::vector<std::string> only{"clean", "laws", "lawless"};
  std::string output = "docs/discovery-benchmark.md";
  app.add_option("-o,--output", output)->capture_default_str();
  app.add_option("--clean", clean, "runs with nothing hidden; a quarter of each other kind of noise")
      ->capture_default_str();
  app.add_option("--runs", runs, "runs of each cell")->capture_default_str();
  app.add_option("--draws", draws, "draws of noise that calibrate a search")->capture_default_str();
  app.add_option("--only", only, "sections: clean laws lawless")->delimiter(',');
  CLI11_PARSE(app, argc, argv);
  const std::string command =
      fmt::format("build/bin/discovery --clean {} --runs {} --draws {}", clean, runs, draws);
  try {
    std::string page = fmt::format(
        "# The discovery benchmark\n\nWritten by this command (its defaults: 1000 clean runs, 60 of each "
        "cell, 2000 draws):\n\n    {}\n\n157 poses of the Table 6 rig (36 "
        "level, 121 "
        "random), 0.05 nT of noise a pose and axis, table angles to 0.1 degrees, a scalar reference, "
        "temperatures up and "
        "down by three degrees, a motor current and a battery that runs down. The laws are written once more "
        "in "
        "`tests/discovery/unknown_law.cc`. Intervals are 95 % (Wilson).\n\n",
        command);
    for (const std::string& section : only)
      page += section == "clean"  ? clean_page(clean, draws)
              : section == "laws" ? laws_page(runs, draws)
                                  : lawless_page(runs, draws);
    std::ofstream(output) << page;
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 1;
  }
  return 0;
}
