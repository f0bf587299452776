// SPDX-License-Identifier: Apache-2.0
// Writes docs/discovery-benchmark.md: laws of no library are hidden in simulated runs, discover is asked, its
// answers are counted.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <fstream>
#include <string>
#include <vector>

#include "tests/discovery/pages.h"

int main(int argc, char** argv) {
  using namespace mgtd::calib::testing;
  CLI::App app{"writes docs/discovery-benchmark.md"};
  Extent extent;
  std::vector<std::string> only{"clean", "laws", "lawless"};
  std::string output = "docs/discovery-benchmark.md";
  app.add_option("-o,--output", output)->capture_default_str();
  app.add_option("--clean", extent.clean, "runs with nothing hidden; a quarter of each other kind of noise")
      ->capture_default_str();
  app.add_option("--runs", extent.runs, "runs of each cell")->capture_default_str();
  app.add_option("--draws", extent.draws, "draws of noise that calibrate a search")->capture_default_str();
  app.add_option("--first-seed", extent.first_seed, "added to all seeds")->capture_default_str();
  app.add_option("--law", extent.law, "regular expression: only the laws that it finds")
      ->capture_default_str();
  app.add_option("--only", only, "sections: clean laws lawless")->delimiter(',');
  CLI11_PARSE(app, argc, argv);
  const std::string command = fmt::format(
      "build/bin/discovery --clean {} --runs {} --draws {}{}", extent.clean, extent.runs, extent.draws,
      extent.first_seed == 0 ? "" : fmt::format(" --first-seed {}", extent.first_seed));
  try {
    std::string page = fmt::format(
        "# The discovery benchmark\n\nWritten by this command (its defaults: 1000 clean runs, 60 of each "
        "cell, 2000 draws):\n\n    {}\n\n157 poses of the Table 6 rig (36 level, 121 "
        "random), 0.05 nT of noise a pose and axis, table angles to 0.1 degrees, a scalar reference, "
        "temperatures up and down by three degrees, a motor current and a battery that runs down. The laws "
        "are written once more in "
        "`tests/discovery/unknown_law.cc`. Intervals are 95 % (Wilson).\n\n",
        command);
    for (const std::string& section : only)
      page += section == "clean"  ? clean_page(extent)
              : section == "laws" ? laws_page(extent)
                                  : lawless_page(extent);
    std::ofstream(output) << page;
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 1;
  }
  return 0;
}
