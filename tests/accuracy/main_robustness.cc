// SPDX-License-Identifier: Apache-2.0
// Writes docs/robustness.md: what gross readings do to a calibration.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <fstream>

#include "tests/accuracy/contamination.h"
#include "tests/accuracy/markdown.h"

namespace mgtd::testing {
namespace {

constexpr std::array<double, 6> kSizes_nT{0.25, 5, 50, 200, 1000, 10'000};

std::string cell(const Robustness& r) {
  const int accepted = r.runs - r.refused;
  if (accepted == 0) return fmt::format("refused {}", r.refused);
  std::string out = fmt::format("{:.2f} ({:.2f})", r.ratio, r.worst);
  if (r.refused > 0) out += fmt::format(", refused {}", r.refused);
  return out;
}

constexpr const char* kOpening =
    "# What gross readings do to a calibration\n\n"
    "This page is written by a program; every figure is computed, none is typed:\n\n"
    "    cmake --preset dev && cmake --build build --target robustness && build/bin/robustness -o "
    "docs/robustness.md\n\n"
    "The rig of Table 6 in 53 907.7 nT is simulated by `tests/support/paper_rigs.cc` without any code of the "
    "estimator: 157 poses, 0.05 nT of noise a pose mean, told by the spreads within the dwells, table 0.1°, "
    "scalar reference 0.05 nT. Then a share of the poses is spoilt.\n\n"
    "**How to read it.** A cell compares the error of the tensor on clean attitudes with that of an oracle, "
    "least squares at the true weights that is told which readings are bad: the ratio of the root mean "
    "squares "
    "over the runs whose calibration is accepted, in brackets the worst single run, then how many runs were "
    "refused (no calibration, or one that its checks do not accept). 0.25 nT is five standard deviations of "
    "the "
    "noise: a reading that is off by so little cannot be told from the others one by one, only the sensor, "
    "the "
    "pose or the stretch can. The limit of the check *bad poses* is a quarter of the poses. *Good readings "
    "left "
    "out*: the largest share over the row's cells.\n\n"
    "A stretch that begins within three poses of an end of the run is not left out, for it may be a step. "
    "Nor is "
    "one where a sensor that moved in its seat for good accounts for more: then its readings are good, and "
    "the "
    "model misses something.\n\n";

std::string clean_line(int runs) {
  const Robustness r = robustness({Gross::axis, 0, 0}, runs);
  return fmt::format(
      "**Nothing spoilt.** {} runs: error of the tensor {:.3f} times the oracle's (which knows the noise of "
      "each axis), {:.4f} % of the readings left out, {} refused.\n\n",
      r.runs, r.ratio, 100 * r.good_left_out, r.refused);
}

/// Nothing where stretches at the ends of the run make no difference.
std::string line_of_ends(const Robustness& r, double share, double size_nT) {
  constexpr double kDifference = 0.05;
  if (r.at_an_end == 0 || r.ratio - r.away_ratio < kDifference) return "";
  return fmt::format(
      "{:g} %, {:g} nT: in {} of the runs the stretch began or ended within three poses of an end of the "
      "run; without these {:.2f}.\n\n",
      100 * share, size_nT, r.at_an_end, r.away_ratio);
}

std::string table_of(Gross kind, const std::vector<double>& shares, int runs) {
  std::vector<std::string> header{"poses"};
  for (const double size : kSizes_nT) header.push_back(fmt::format("{:g} nT", size));
  header.emplace_back("good readings left out");
  MarkdownTable out(header);
  std::string ends;
  for (const double share : shares) {
    std::vector<std::string> cells{fmt::format("{:g} %", 100 * share)};
    double good = 0;
    for (const double size : kSizes_nT) {
      const Robustness r = robustness({kind, share, size}, runs);
      std::fprintf(stderr, "%s, %g %%, %g nT: %s\n", name(kind).c_str(), 100 * share, size, cell(r).c_str());
      cells.push_back(cell(r));
      ends += line_of_ends(r, share, size);
      good = std::max(good, r.good_left_out);
    }
    cells.push_back(fmt::format("{:.2f} %", 100 * good));
    out.line(cells);
  }
  return fmt::format("## Spoilt: {}\n\n", name(kind)) + out.text() + ends;
}

}  // namespace
}  // namespace mgtd::testing

int main(int argc, char** argv) {
  CLI::App app{"spoil simulated runs, calibrate, and write docs/robustness.md", "robustness"};
  int runs = 20;
  std::string output;
  std::vector<double> shares{0.01, 0.05, 0.1, 0.2, 0.3};
  std::vector<int> kinds{0, 1, 4, 2, 3};
  app.add_option("--runs", runs, "per cell")->capture_default_str();
  app.add_option("--shares", shares, "of the poses")->capture_default_str();
  app.add_option("--kinds", kinds, "0 axis, 1 sensor, 2 pose, 3 stretch, 4 sensor in scattered poses")
      ->capture_default_str();
  app.add_option("-o,--output", output, "file; standard output when absent");
  CLI11_PARSE(app, argc, argv);
  try {
    std::string text = mgtd::testing::kOpening + mgtd::testing::clean_line(5 * runs);
    for (const int kind : kinds)
      text += mgtd::testing::table_of(static_cast<mgtd::testing::Gross>(kind), shares, runs);
    if (output.empty()) {
      fmt::print("{}", text);
    } else {
      std::ofstream(output) << text;
    }
  } catch (const std::exception& error) {
    fmt::print(stderr, "robustness: {}\n", error.what());
    return 1;
  }
  return 0;
}
