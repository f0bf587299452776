// SPDX-License-Identifier: Apache-2.0
#include "calib/report/discovery_reason.h"

#include <fmt/format.h>

#include <cmath>

#include "calib/stats/probability.h"
#include "proto/shell_word.h"

namespace mgtd::calib::report {
namespace {

using discovery::DiscoveryReport;
using discovery::FoundLaw;
using Rule = discovery::LawFindingReason::Rule;

std::string random_offset(const FoundLaw& law, bool jumps) {
  return jumps ? fmt::format("an offset that jumps from pose to pose at {}", law.random_where)
               : walk_text(law);
}

bool jumps_instead(const FoundLaw& law) { return law.over_jumps < law.over_walk; }

std::string odds_text(const DiscoveryReport& r) {
  const FoundLaw& law = r.laws[r.reason.law];
  return fmt::format("2 ln of the odds of {} against {} is {:.1f}; a law needs {:.1f}",
                     r.laws.size() > 1 ? fmt::format("law {}", r.reason.law + 1) : "all formulas",
                     random_offset(law, jumps_instead(law)), r.reason.measured, r.reason.limit);
}

}  // namespace

std::string walk_text(const FoundLaw& law) {
  if (law.random_where == discovery::Place{discovery::Place::Kind::gradient, 0}.name())
    return "a gradient of the site that walks";
  return "an offset that walks at " + law.random_where;
}

std::string_view rule_name(Rule rule) {
  switch (rule) {
    case Rule::nothing_found:
      return "nothing-found";
    case Rule::only_scatter:
      return "only-scatter";
    case Rule::only_wander:
      return "only-wander";
    case Rule::walk_instead:
      return "walk-instead";
    case Rule::random_instead:
      return "random-instead";
    case Rule::random_near:
      return "random-near";
    case Rule::random_beside:
      return "random-beside";
    case Rule::drift:
      return "drift";
    case Rule::library:
      return "library";
    case Rule::few_periods:
      return "few-periods";
    case Rule::law_left:
      return "law-left";
    case Rule::scatter_left:
      return "scatter-left";
    case Rule::formulas_open:
      return "formulas-open";
    case Rule::none:
      return "none";
  }
  return "";
}

std::string reason_text(const DiscoveryReport& r) {
  const double measured = r.reason.measured, limit = r.reason.limit;
  switch (r.reason.rule) {
    case Rule::nothing_found:
      return fmt::format("the whole search finds as much in noise with p {}; a law needs p below {:.3g}",
                         stats::p_text(measured), std::pow(10, limit));
    case Rule::only_scatter:
      return fmt::format(
          "no formula stands out, and chi-square of {} is {:.1f} standard deviations above its noise; up to "
          "{:.1f} count as noise",
          r.left_on, measured, limit);
    case Rule::only_wander:
      return "no formula stands out, and the offsets of this run wander";
    case Rule::walk_instead:
      return fmt::format(
          "beside the offsets that wander on this run the law has p {}; a law needs p below {:.3g}",
          stats::p_text(measured), std::pow(10, limit));
    case Rule::random_instead:
    case Rule::random_near:
      return odds_text(r);
    case Rule::random_beside: {
      const FoundLaw& law = r.laws.front();
      return fmt::format(
          "what the formulas leave is no noise: 2 ln of the odds of {} beside them is {:.1f}; a law needs it "
          "below {:.0f}",
          random_offset(law, law.jumps_P > law.walk_P), measured, limit);
    }
    case Rule::drift:
      return "one sample a pose: samples that follow one another are no replicates, and what drifts for a "
             "while, whatever its cause, looks like such a law";
    case Rule::library:
      return fmt::format("an effect of the library leads, with P {:.3f}", measured);
    case Rule::few_periods:
      return fmt::format(
          "the oscillation{} passes {:.2g} of its periods in this run; a law needs {:.0f}, because what "
          "comes once is any curve",
          r.laws.size() > 1 ? fmt::format(" of law {}", r.reason.law + 1) : "", measured, limit);
    case Rule::law_left:
      return fmt::format(
          "another search of what the formulas leave finds more, with p {}; a law needs p above {:.3g} there",
          stats::p_text(measured), std::pow(10, limit));
    case Rule::scatter_left:
      return fmt::format(
          "after the formulas chi-square of {} is {:.1f} standard deviations above its noise; a law needs "
          "less than {:.1f}",
          r.left_on, measured, limit);
    case Rule::formulas_open:
      return fmt::format("the formula that leads{} has P {:.3f}; a law needs P above {:.3g}",
                         r.laws.size() > 1 ? fmt::format(" law {}", r.reason.law + 1) : "", measured, limit);
    case Rule::none:
      return {};
  }
  return {};
}

std::string what_next(const DiscoveryReport& r, const std::string& run,
                      const std::vector<std::string>& kept) {
  const std::string repeat = "repeat the run: what walks does not repeat, and a law does";
  const std::string record =
      "record what switches between the poses (supplies, loads, presence) and run again";
  switch (r.reason.rule) {
    case Rule::nothing_found:
      return "nothing: no formula stands out from the noise of this run";
    case Rule::only_wander:
    case Rule::walk_instead:
      return repeat;
    case Rule::only_scatter:
      return record;
    case Rule::random_instead:
    case Rule::random_near:
      return jumps_instead(r.laws[r.reason.law]) ? record : repeat;
    case Rule::drift:
      return "stay at each attitude for some seconds, come back to the first ones at the end, and compare: "
             "what drifts does not come back with the attitude";
    case Rule::few_periods:
      return "measure for longer, or again: a law comes back, and what passed by once does not";
    case Rule::random_beside:
    case Rule::law_left:
    case Rule::scatter_left:
      return "record more (supplies, loads, temperatures of the electronics) and run again; mgt report " +
             run + " shows the residual against everything that was recorded";
    case Rule::library:
      return "mgt explain " + run + " names it, with its alternatives and what it costs";
    case Rule::formulas_open:
    case Rule::none:
      if (!kept.empty())
        return fmt::format(
            "the formula stays exploratory until a second run confirms it: mgt define SECOND.mgtrun {} "
            "--from {}",
            kept.front(), shell_word(run));
      return r.laws.front().formulas.front().specs.empty()
                 ? "measure again, and look whether the same formula leads"
                 : "keep the formula with the commands below; it stays exploratory until a second run "
                   "confirms it (mgt define --from)";
  }
  return {};
}

}  // namespace mgtd::calib::report
