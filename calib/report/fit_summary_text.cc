// SPDX-License-Identifier: Apache-2.0
#include "calib/report/fit_summary_text.h"

#include <fmt/format.h>

#include "calib/fit/joint/joint_limits.h"

namespace mgtd::calib::report {
namespace {

std::string ending(const fit::FitSummary& s) {
  switch (s.termination) {
    case fit::Termination::closed_form:
      return "solved in closed form";
    case fit::Termination::converged:
      return "converged";
    case fit::Termination::slow_progress:
      return fmt::format(
          "stopped at the limit of {} steps, where chi-square only crept (less than {} in {} steps)",
          fit::joint::kMaxIterations, fit::joint::kSlowFall, fit::joint::kSlowIterations);
    case fit::Termination::round_limit:
      return fmt::format("stopped at the limit of {} rounds, noise or left-out readings still changing",
                         fit::joint::kMaxWeighingRounds);
  }
  return "";
}

}  // namespace

std::string_view to_string(fit::Termination termination) {
  switch (termination) {
    case fit::Termination::closed_form:
      return "closed-form";
    case fit::Termination::converged:
      return "converged";
    case fit::Termination::slow_progress:
      return "slow-progress";
    case fit::Termination::round_limit:
      return "round-limit";
  }
  return "";
}

std::string to_text(const fit::FitSummary& s) {
  const std::string count = s.termination == fit::Termination::closed_form
                                ? std::string()
                                : fmt::format(" in {} round{}, {} step{}", s.rounds, s.rounds == 1 ? "" : "s",
                                              s.iterations, s.iterations == 1 ? "" : "s");
  return fmt::format("{}{}: chi-square fell from {:.5g} to {:.5g}", ending(s), count, s.initial_cost,
                     s.final_cost);
}

}  // namespace mgtd::calib::report
