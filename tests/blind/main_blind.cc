// SPDX-License-Identifier: Apache-2.0
// Writes docs/blind-benchmark.md: laws are hidden in simulated runs, explain and improve are asked, their
// answers are counted.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <exception>
#include <fstream>
#include <optional>

#include "tests/blind/page.h"
#include "tests/blind/real_kind.h"

namespace mgtd::calib::testing {
namespace {

struct Section {
  const char* name;
  std::string (*write)(const Sizes&);
};
constexpr std::array kSections{Section{"clean", &clean_page},
                               Section{"naming", &naming_page},
                               Section{"one-field", &one_field_page},
                               Section{"one-sensor", &one_sensor_page},
                               Section{"two", &two_page},
                               Section{"open", &open_page},
                               Section{"oracle", &oracle_page},
                               Section{"paper", &paper_page},
                               Section{"real-noise", &real_noise_page},
                               Section{"site", &site_page}};

std::string page(const Sizes& n, const std::vector<std::string>& only, const std::string& command) {
  std::string out = fmt::format(
      "# The blind benchmark\n\nWritten by this command (1000 clean runs and 60 of each cell, its defaults, "
      "take more than an hour of one core; sections may be written one by one):\n\n    {}\n\n157 poses of "
      "the Table 6 "
      "rig (36 level, 121 random), 0.3 nT of noise a pose, table angles to 0.1 degrees, a scalar reference, "
      "temperatures up and down by 3 degrees. The laws are written once more in "
      "`tests/blind/hidden_law.cc`. Intervals are 95 % (Wilson).\n\n",
      command);
  for (const Section& section : kSections) {
    if (only.empty() || std::find(only.begin(), only.end(), section.name) != only.end())
      out += section.write(n);
  }
  return out;
}

/// A misspelt name would measure nothing without a word.
std::string refuse_unknown_kind(const std::string& name) {
  const auto called = [&](const RealKind& kind) { return is_called(kind, name); };
  for (const auto* kinds : {&real_kinds(), &site_kinds()})
    if (std::any_of(kinds->begin(), kinds->end(), called)) return {};
  return fmt::format("no kind of run is called '{}'", name);
}

}  // namespace
}  // namespace mgtd::calib::testing

int main(int argc, char** argv) {
  using namespace mgtd::calib::testing;
  CLI::App app{"writes docs/blind-benchmark.md"};
  Sizes sizes;
  std::vector<std::string> only;
  std::string output = "docs/blind-benchmark.md";
  app.add_option("-o,--output", output)->capture_default_str();
  app.add_option("--clean", sizes.clean, "clean runs of each kind of noise")->capture_default_str();
  std::optional<int> runs;
  app.add_option("--runs", runs, "runs of each cell [60; 200 of real-noise and site]");
  app.add_option("--only", only,
                 "sections: clean naming one-field one-sensor two open oracle paper real-noise site")
      ->delimiter(',');
  app.add_option("--kind", sizes.kinds, "kinds of real-noise and site; 'walk' also stands for walk-1")
      ->delimiter(',')
      ->check(&refuse_unknown_kind);
  app.add_option("--first-seed", sizes.first_seed, "of real-noise and site")->capture_default_str();
  app.add_option("--keep", sizes.keep, "folder for the pose tables of runs that went wrong there");
  app.add_option("--answers", sizes.answers,
                 "file of what was answered there, a line a run; those that it holds are not asked again, so "
                 "that a campaign can be interrupted and go on");
  CLI11_PARSE(app, argc, argv);
  if (runs) sizes.runs = sizes.real = *runs;
  const std::string command =
      fmt::format("blind --clean {} --runs {}{}{} -o docs/blind-benchmark.md", sizes.clean, sizes.runs,
                  only.empty() ? "" : " --only ", fmt::join(only, ","));
  try {
    std::ofstream(output) << page(sizes, only, command);
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 1;
  }
  return 0;
}
