// SPDX-License-Identifier: Apache-2.0
// Writes docs/accuracy.md: the paper's tables, the Cramer-Rao bound, and what the uncertainties are worth.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <fstream>

#include "tests/accuracy/alarms.h"
#include "tests/accuracy/campaign.h"
#include "tests/accuracy/markdown.h"
#include "tests/accuracy/paper_tables.h"

namespace mgtd::testing {
namespace {

struct Sizes {
  int paper_seeds{5}, bound_seeds{400}, runs{300}, alarm_runs{1000};
};

/// What the sections find, for the lines at the top of the page.
struct Summary {
  double worst_over_bound{0}, joint_500{0}, two_step_500{0}, two_step_gradient{0}, joint_gradient{0};
  double nees{0}, band_low{0}, band_high{0}, unknowns{0}, covered{0};
  std::string false_check, false_diff;
};

std::string in_short(const Summary& s) {
  return fmt::format(
      "**In short.** From 500 poses with 1 nT of noise the joint calibration brings {:.2f} nT/m into the "
      "worst component "
      "of the tensor, the two-step {:.2f}; where the site has a gradient of up to 50 nT/m {:.2f} with "
      "`--with site.gradient`, the "
      "two-step {:.0f}. For 100 to 5832 poses, with and without gradient, no component is worse than {:.3f} "
      "times the "
      "Cramér-Rao bound. The reported covariance is the real one (mean NEES {:.1f} of {:.0f}, 99.9 % band "
      "{:.1f} to {:.1f}), "
      "and {:.1f} % of the 95 % intervals hold the truth. An unchanged rig is called changed by `mgt check` "
      "in {}, by "
      "`mgt diff` in {}.\n\n",
      s.joint_500, s.two_step_500, s.joint_gradient, s.two_step_gradient, s.worst_over_bound, s.nees,
      s.unknowns, s.band_low, s.band_high, 100 * s.covered, s.false_check, s.false_diff);
}

std::string opening(const Sizes& s) {
  return fmt::format(
      "# How accurate\n\n"
      "This page is written by a program; every figure is computed, none is typed:\n\n"
      "    cmake --preset dev && cmake --build build --target accuracy && build/bin/accuracy -o "
      "docs/accuracy.md\n\n"
      "The rigs are simulated by `tests/support/paper_rigs.cc`, from the paper's equations and without any "
      "code of the "
      "estimator. The paper is Li Qingzhu et al., *Two-step linear calibration of planar cross magnetic "
      "gradient tensor "
      "system*; its figures are in `tests/data/paper/`.\n\n"
      "**How to read it.** A residual on the poses of the fit contains the noise of these poses, which no "
      "calibration "
      "removes: the *floor* is what the true parameters leave on the same data. What a calibration is worth "
      "shows on "
      "clean attitudes: the error that it alone brings into the tensor. The least possible is the "
      "*Cramér-Rao bound*, "
      "computed from the same poses, noise and table at the true parameters. Seeds: {} for the bound, {} "
      "runs for the "
      "covariance, {} for the alarms.\n\n",
      s.bound_seeds, s.runs, s.alarm_runs);
}

void note(const Scene& scene, const TensorErrors& e, Summary& out) {
  out.worst_over_bound = std::max(out.worst_over_bound, (e.joint / e.bound).maxCoeff());
  if (scene.poses != 500) return;
  (scene.gradient ? out.joint_gradient : out.joint_500) = e.joint.maxCoeff();
  (scene.gradient ? out.two_step_gradient : out.two_step_500) = e.two_step.maxCoeff();
}

std::string bound_section(int seeds, Summary& summary) {
  MarkdownTable out(
      {"poses", "site gradient", "", "xx", "yy", "zz", "xy", "xz", "yz", "joint / bound, worst"});
  for (const bool gradient : {false, true}) {
    for (const std::size_t poses : {100UL, 157UL, 500UL, 5832UL}) {
      Scene scene;
      scene.poses = poses;
      scene.gradient = gradient;
      const TensorErrors e = tensor_errors(scene, seeds);
      note(scene, e, summary);
      std::fprintf(stderr, "bound: %zu poses%s\n", poses, gradient ? ", gradient" : "");
      const auto row = [&](const std::string& name, const Components& c, const std::string& last) {
        std::vector<std::string> cells{std::to_string(poses), gradient ? "yes" : "none", name};
        for (const double v : c) cells.push_back(fmt::format("{:.3f}", v));
        cells.push_back(last);
        out.line(cells);
      };
      row("two-step", e.two_step, "");
      row(gradient ? "joint with `site.gradient`" : "joint", e.joint,
          fmt::format("**{:.3f}**", (e.joint / e.bound).maxCoeff()));
      row("bound", e.bound, "");
    }
  }
  return "## Against the Cramér-Rao bound\n\nError of the tensor by the calibration alone, nT/m, rms over "
         "seeds and 300 clean "
         "attitudes. The rig of Table 6, 53 907.7 nT, 1 nT of noise per pose mean and axis, table 0.1°, "
         "scalar reference "
         "0.05 nT; 36 standard poses, the others random. The noise and the table's accuracy are found by the "
         "fit. *Site gradient*: Gxx 30, Gyy −45, Gxy −20, Gxz 50, Gyz 10 nT/m.\n\n" +
         out.text();
}

std::string consistency_section(int runs, Summary& summary) {
  MarkdownTable out({"157 poses", "runs", "mean NEES", "99.9 % band", "95 % intervals that hold the truth",
                     "worst parameter"});
  for (const bool gradient : {false, true}) {
    Scene scene;
    scene.gradient = gradient;
    const Consistency c = consistency(scene, runs);
    if (!gradient) {
      summary.nees = c.nees;
      summary.unknowns = c.unknowns;
      summary.band_low = c.band_low;
      summary.band_high = c.band_high;
      summary.covered = c.covered;
    }
    out.line({gradient ? "site gradient, and `site.gradient` in the model" : "no gradient",
              std::to_string(c.runs), fmt::format("{:.2f} of {:.0f}", c.nees, c.unknowns),
              fmt::format("{:.2f} to {:.2f}", c.band_low, c.band_high),
              fmt::format("{:.2f} % of {}", 100 * c.covered, c.intervals),
              fmt::format("{} {:.1f} %", c.worst, 100 * c.worst_covered)});
  }
  return "## Is the reported uncertainty the real one?\n\nThe normalised estimation error squared (NEES) "
         "weighs the real error of all parameters with the covariance that the fit reports; its mean must be "
         "the number of parameters. The noise of each axis is found from some 114 degrees of freedom, which "
         "by itself makes the mean 1.8 % larger.\n\n" +
         out.text();
}

std::string share(int count, int runs) {
  return fmt::format("{:.2f} % ({} of {})", 100.0 * count / runs, count, runs);
}

std::string alarm_section(int runs, Summary& summary) {
  const Alarms a = alarms({}, runs);
  summary.false_check = share(a.false_check, a.runs);
  summary.false_diff = share(a.false_diff, a.runs);
  const Foretold f = foretold({}, runs / 3);
  MarkdownTable out({"command", "question", "stated", "found"});
  out.line({"`mgt check`, 12 poses", "unchanged rig called changed", "1 %", share(a.false_check, a.runs)});
  out.line({"`mgt check`, 12 poses",
            fmt::format("an offset changed by the size it states (mean {:.2f} nT) is seen", a.size_nT),
            "80 %", share(a.seen_check, a.runs)});
  out.line({"", "… and the parameter named rightly", "", share(a.named_check, a.runs)});
  out.line({"`mgt diff`, 157 and 157 poses", "unchanged rig called different", "1 %",
            share(a.false_diff, a.runs)});
  out.line({"`mgt plan`, 157 poses", "real error over foretold, rms of 48 parameters", "1",
            fmt::format("{:.3f}", f.rms_ratio)});
  out.line({"", fmt::format("… of a single parameter, {} runs", f.runs),
            fmt::format("1 ± {:.3f}", f.expected_spread),
            fmt::format("{:.3f} to {:.3f}", f.lowest, f.highest)});
  return "## Answers that are yes or no, and forecasts\n\n" + out.text() +
         "One case of a hundred means 10 ± 3 of 1000.\n\n";
}

constexpr const char* kClosing =
    "## What cannot be reproduced\n\n"
    "- The *before* rows of Tables 1, 2 and 4, and *simplified linear* of Table 1: they depend on the "
    "attitudes, whose "
    "convention the paper leaves open, and on readings that are not published.\n"
    "- The two-step row of Table 2: below the floor of a 0.4 m cross with the stated noise.\n"
    "- The rows of the experiment in Tables 4 and 5, and the values of Table 6: without the readings they "
    "can be "
    "simulated and not computed again.\n"
    "- Nothing here was measured on hardware. The simulated noise is white, the simulated sensors follow the "
    "model "
    "exactly but for what is said; a real rig has drifts and disturbances, which is what the rest of this "
    "program is "
    "about.\n";

std::string page(const Sizes& s) {
  Summary summary;
  std::string body = bound_section(s.bound_seeds, summary);
  body += consistency_section(s.runs, summary);
  body += alarm_section(s.alarm_runs, summary);
  body += simulation_section(s.paper_seeds);
  body += experiment_section();
  return opening(s) + in_short(summary) + body + kClosing;
}

}  // namespace
}  // namespace mgtd::testing

int main(int argc, char** argv) {
  CLI::App app{"simulate, calibrate, and write docs/accuracy.md", "accuracy"};
  mgtd::testing::Sizes sizes;
  std::string output;
  app.add_option("--seeds", sizes.bound_seeds, "per row of the comparison with the bound")
      ->capture_default_str();
  app.add_option("--runs", sizes.runs, "for the covariance")->capture_default_str();
  app.add_option("--alarm-runs", sizes.alarm_runs, "for check, diff and plan")->capture_default_str();
  app.add_option("--paper-seeds", sizes.paper_seeds, "for the paper's simulation")->capture_default_str();
  app.add_option("-o,--output", output, "file; standard output when absent");
  CLI11_PARSE(app, argc, argv);
  try {
    const std::string text = mgtd::testing::page(sizes);
    if (output.empty()) {
      fmt::print("{}", text);
    } else {
      std::ofstream(output) << text;
    }
  } catch (const std::exception& error) {
    fmt::print(stderr, "accuracy: {}\n", error.what());
    return 1;
  }
  return 0;
}
