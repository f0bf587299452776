// SPDX-License-Identifier: Apache-2.0
// Writes docs/clocks.md: is the skew bound of an epoch true, and how wide is it?
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <fstream>

#include "tests/accuracy/markdown.h"
#include "tests/unit/daemon/acquire/clock_trial.h"

namespace mgtd::testing {
namespace {

using test::ClockGrid;
using test::run_trial;
using test::Trial;
using test::TrialResult;

constexpr double kMs = 1e3;
constexpr std::size_t kWrong = 2;  ///< the sensor whose rate is off

constexpr const char* kOpening =
    "# Is the skew bound true?\n\n"
    "This page is written by a program; every figure is computed, none is typed:\n\n"
    "    cmake --preset dev && cmake --build build --target clocks && build/bin/clocks --hours {0:g} -o "
    "docs/clocks.md\n\n"
    "Four free-running devices at 50 Hz, their oscillators off by up to the given ppm to both sides, hand "
    "their "
    "samples over when a timer ticks (`tests/unit/daemon/acquire/clock_trial.h`). The daemon's sampler makes "
    "epochs "
    "of "
    "them, knowing nothing of the timers but the default `delivery_s = 0.016`. Each epoch's true skew, the "
    "largest difference between the times at which its four readings were taken, is held against the "
    "`skew_bound_s` that it states.\n\n"
    "**What the bound means.** No two readings of an epoch were taken further apart, as long as delivery "
    "ordinarily takes no longer than `delivery_s` plus 0.5 ms and a rate changes by no more than 11 ppm in "
    "an "
    "hour. A delay that all samples of a sensor have in common does not show in the arrivals: up to "
    "`delivery_s` it is in the bound, and a longer one is to be configured as `latency_s`. One that all four "
    "have alike makes no skew.\n\n"
    "**Why it is wide with a short step.** The arrivals of a timer that keeps step with the samples look "
    "like "
    "those without a timer. So the bound assumes the step of `delivery_s` until the delays that are seen "
    "fill "
    "it. Where the converter's timer is known to be shorter (the log says so when the port is opened), "
    "`delivery_s = 0.001` says so, and the bound follows: second table.\n\n"
    "A *beat* is the time in which the part of a delay that all samples have in common sweeps once through "
    "what there is of it: 4 ms of a step of 16, 8 or 4 ms, 1 ms of 1. *own*: the timers keep the computer's "
    "time and the oscillators make the beat; *none*: the timers follow the oscillators for ever. A cell: "
    "share "
    "of the epochs whose true skew exceeds the bound / the bound after 1 min / at the end, ms.\n\n";

std::string beat_name(double beat_s) {
  return beat_s == 0 ? "own" : beat_s < 0 ? "none" : fmt::format("{:g} s", beat_s);
}

std::string cell(const TrialResult& r) {
  return fmt::format("{:.3f} % / {:.2f} / {:.2f}", 100 * r.violated_share(), kMs * r.at_1_min_s,
                     kMs * r.at_end_s);
}

struct Totals {
  std::uint64_t epochs{0}, violated{0};
  double worst_share{0};
  void add(const TrialResult& r) {
    epochs += r.epochs;
    violated += r.violated;
    worst_share = std::max(worst_share, r.violated_share());
  }
  [[nodiscard]] std::string text() const {
    return fmt::format("\n{} epochs, {} beyond their bound; {:.4f} % in the worst cell.\n\n", epochs,
                       violated, 100 * worst_share);
  }
};

std::string grid(double hours, bool known) {
  std::vector<std::string> header{"step", "oscillators"};
  for (const double beat_s : ClockGrid::kBeats_s) header.push_back("beat " + beat_name(beat_s));
  MarkdownTable out(header);
  Totals totals;
  for (const double step_s : ClockGrid::kSteps_s) {
    if (known && step_s == ClockGrid::kSteps_s.back()) continue;
    for (const double ppm : ClockGrid::kOscillators_ppm) {
      std::vector<std::string> cells{fmt::format("{:g} ms", kMs * step_s), fmt::format("±{:g} ppm", ppm)};
      for (const double beat_s : ClockGrid::kBeats_s) {
        Trial trial = test::grid_trial(step_s, ppm, beat_s);
        trial.to_s = 3600 * hours;
        if (known) trial.config.step_s.fill(step_s);
        const TrialResult r = run_trial(trial);
        totals.add(r);
        cells.push_back(cell(r));
        std::fprintf(stderr, "step %g ms, %g ppm, beat %s: %s\n", kMs * step_s, ppm,
                     beat_name(beat_s).c_str(), cells.back().c_str());
      }
      out.line(cells);
    }
  }
  return out.text() + totals.text();
}

/// Delivery every 16 ms.
std::string rates(double hours) {
  MarkdownTable out({"rate", "beyond the bound", "flagged, s", "rate error as estimated",
                     "bound after 1 min, ms", "at the end, ms"});
  for (const double percent : {-10.0, -5.0, -1.0, -0.2, 0.2, 1.0, 5.0, 10.0}) {
    Trial trial = test::grid_trial(0.016, 20, 0);
    trial.devices.at(kWrong).ppm = 1e6 * (1 / (1 + percent / 100) - 1);
    trial.to_s = 3600 * hours;
    const TrialResult r = run_trial(trial);
    const daemon::acquire::ClockState& clock = r.health.sensors.at(kWrong).clock;
    out.line({fmt::format("{:+g} %", percent), fmt::format("{:.4f} %", 100 * r.violated_share()),
              fmt::format("{:.1f}", static_cast<double>(r.flagged) * trial.period_s),
              fmt::format("{:+.4f} ± {:.4f} %", 100 * clock.rate_error, 100 * clock.rate_error_pm),
              fmt::format("{:.2f}", kMs * r.at_1_min_s), fmt::format("{:.2f}", kMs * r.at_end_s)});
  }
  return out.text() + "\n";
}

/// Ten minutes into an hour.
std::string changes() {
  MarkdownTable out(
      {"change", "step", "beyond the bound, s", "of these not flagged, s", "by at most, ms", "flagged, s"});
  for (const double ppm : {-10'000.0, -500.0, 500.0, 2000.0, 10'000.0, 50'000.0}) {
    for (const double step_s : {0.001, 0.016}) {
      Trial trial = test::grid_trial(step_s, 20, 0);
      trial.devices.at(kWrong).change_ppm = ppm;
      trial.devices.at(kWrong).change_at_s = 600;
      trial.to_s = 3600;
      const TrialResult r = run_trial(trial);
      out.line({fmt::format("{:g} % {}", std::abs(ppm) / 1e4, ppm > 0 ? "slower" : "faster"),
                fmt::format("{:g} ms", kMs * step_s),
                fmt::format("{:.1f}", static_cast<double>(r.violated) * trial.period_s),
                fmt::format("{:.1f}", static_cast<double>(r.silent) * trial.period_s),
                fmt::format("{:.1f}", kMs * std::max(0.0, r.worst_excess_s)),
                fmt::format("{:.1f}", static_cast<double>(r.flagged) * trial.period_s)});
    }
  }
  return out.text() + "\n";
}

/// Host scheduling and wandering oscillators on top of a timer.
std::string disturbed(double hours) {
  MarkdownTable out(
      {"step", "jitter of the host", "rate wanders by", "beyond the bound", "bound at the end, ms"});
  for (const double step_s : ClockGrid::kSteps_s) {
    for (const double jitter_s : {0.0, 0.1e-3, 1e-3}) {
      for (const double wander_ppm : {0.0, 1.0}) {
        if (jitter_s == 0 && wander_ppm == 0) continue;
        Trial trial = test::grid_trial(step_s, 50, 0);
        for (auto& device : trial.devices) {
          device.jitter_s = jitter_s;
          device.wander_ppm = wander_ppm;
        }
        trial.devices[1].wander_period_s = 5000;
        trial.to_s = 3600 * hours;
        const TrialResult r = run_trial(trial);
        out.line({fmt::format("{:g} ms", kMs * step_s), fmt::format("{:g} ms", kMs * jitter_s),
                  fmt::format("{:g} ppm", wander_ppm), fmt::format("{:.4f} %", 100 * r.violated_share()),
                  fmt::format("{:.2f}", kMs * r.at_end_s)});
      }
    }
  }
  return out.text() + "\n";
}

}  // namespace
}  // namespace mgtd::testing

int main(int argc, char** argv) {
  CLI::App app{"play timers against the sampler, and write docs/clocks.md", "clocks"};
  double hours = 2;
  std::string output;
  app.add_option("--hours", hours, "of virtual time, per cell")->capture_default_str();
  app.add_option("-o,--output", output, "file; standard output when absent");
  CLI11_PARSE(app, argc, argv);
  using namespace mgtd::testing;
  try {
    std::string text = fmt::format(kOpening, hours);
    text += fmt::format("## Steps, oscillators and beats, {:g} h each\n\n", hours) + grid(hours, false);
    text += "## The same with `delivery_s` as the step is\n\n" + grid(hours, true);
    text +=
        fmt::format(
            "## A digitiser whose rate is wrong\n\ns3 of four, delivered every 16 ms, {:g} h each. The size "
            "of the error is in the log and in `mgt status` once it is known to a tenth. Beyond 10 % the "
            "driver tells the digitiser its settings again.\n\n",
            hours) +
        rates(hours);
    text +=
        "## A rate that changes at once\n\ns3, ten minutes into an hour. The bound of the old rate holds "
        "until "
        "the arrivals contradict it; then its clock is learnt anew, and its epochs say "
        "`clock_unsettled`.\n\n" +
        changes();
    text += fmt::format(
                "## Jitter and wander\n\nThe host is late by chance (exponential, this mean) on top of the "
                "timer, "
                "and the rates wander as a sine of an hour. Oscillators ±50 ppm, {:g} h each.\n\n",
                hours) +
            disturbed(hours);
    if (output.empty()) {
      fmt::print("{}", text);
    } else {
      std::ofstream(output) << text;
    }
  } catch (const std::exception& error) {
    fmt::print(stderr, "clocks: {}\n", error.what());
    return 1;
  }
  return 0;
}
