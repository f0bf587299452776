// SPDX-License-Identifier: Apache-2.0
// Writes docs/discovery-benchmark.md: laws of no library are hidden in simulated runs, discover is asked, its
// answers are counted. Section by section, because the whole takes hours: --only leaves the others as they
// stand in the file.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/discovery/pages.h"
#include "tests/support/whole_file.h"

namespace {

using namespace mgtd::calib::testing;

struct Section {
  const char *name, *heading;
  std::string (*page)(const Extent&);
  std::string options;  ///< that this section depends on
};

std::vector<Section> sections(const Extent& extent) {
  const std::string common =
      fmt::format("--draws {}{}", extent.draws,
                  extent.first_seed == 0 ? "" : fmt::format(" --first-seed {}", extent.first_seed));
  const std::string cells = fmt::format("--runs {} {}", extent.runs, common);
  const std::string of_some = extent.law == ".*" ? "" : fmt::format(" --law '{}'", extent.law);
  return {{"clean", "## Nothing hidden\n\n", clean_page, fmt::format("--clean {} {}", extent.clean, common)},
          {"laws", "## Laws of the grammar\n\n", laws_page, cells + of_some},
          {"rising", "## The same laws, while the room warms up once\n\n", rising_page, cells + of_some},
          {"lawless", "## What is no formula of the grammar\n\n", lawless_page, cells}};
}

/// A section as it stands in a file, up to the next heading.
std::string standing(const std::string& file, const std::string& heading) {
  const auto from = file.find(heading);
  if (from == std::string::npos)
    throw std::runtime_error(
        fmt::format("the file has no section '{}' that could stay as it is: write it, "
                    "too (--only), or give the file that has it (-o)",
                    heading.substr(3, heading.find('\n') - 3)));
  const auto next = file.find("\n## ", from);
  return file.substr(from, next == std::string::npos ? next : next + 1 - from);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"writes docs/discovery-benchmark.md"};
  Extent extent;
  std::vector<std::string> only{"clean", "laws", "rising", "lawless"};
  std::string output = "docs/discovery-benchmark.md";
  app.add_option("-o,--output", output)->capture_default_str();
  app.add_option("--clean", extent.clean, "runs with nothing hidden; a quarter of each other kind of noise")
      ->capture_default_str();
  app.add_option("--runs", extent.runs, "runs of each cell")->capture_default_str();
  app.add_option("--draws", extent.draws, "draws of noise that calibrate a search")->capture_default_str();
  app.add_option("--first-seed", extent.first_seed, "added to all seeds")->capture_default_str();
  app.add_option("--law", extent.law, "regular expression: only the laws that it finds")
      ->capture_default_str();
  app.add_option(
      "--answers", extent.answers,
      "file of what was answered, a line a run; those that it holds are not asked again, so that a "
      "campaign can be interrupted and go on");
  app.add_option("--only", only,
                 "sections: clean laws rising lawless; the others stay as they are in the file")
      ->delimiter(',')
      ->check(CLI::IsMember({"clean", "laws", "rising", "lawless"}));
  CLI11_PARSE(app, argc, argv);
  try {
    const std::string before = mgtd::testing::whole_file(output);
    for (const Section& section : sections(extent))  // before hours of work
      if (std::find(only.begin(), only.end(), section.name) == only.end()) standing(before, section.heading);
    std::string page =
        "# The discovery benchmark\n\nEach section is written by the command that stands at its head "
        "(defaults: 1000 clean runs, 60 of each cell, 2000 draws). 157 poses of the Table 6 rig (36 level, "
        "121 random), 0.05 nT of noise a pose and axis, table angles to 0.1 degrees, a scalar reference, "
        "temperatures up and down by three degrees (in one section up once by six), a motor current and a "
        "battery that runs down. The laws "
        "are written once more in `tests/discovery/unknown_law.cc`. Intervals are 95 % (Wilson).\n\n";
    for (const Section& section : sections(extent)) {
      if (std::find(only.begin(), only.end(), section.name) == only.end()) {
        page += standing(before, section.heading);
        continue;
      }
      page += fmt::format("{}    build/bin/discovery --only {} {}\n\n", section.heading, section.name,
                          section.options);
      page += section.page(extent).substr(std::string(section.heading).size());
    }
    std::ofstream(output) << page;
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 1;
  }
  return 0;
}
