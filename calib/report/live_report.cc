// SPDX-License-Identifier: Apache-2.0
#include "calib/report/live_report.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>

#include "calib/report/rearrangement_text.h"
#include "calib/stats/chi_square.h"
#include "calib/stats/probability.h"

namespace mgtd::calib::report {
namespace {

constexpr std::array<const char*, 2> kPer{"degC", "h"};
constexpr std::array<std::string_view, 3> kFollowsNames{"temperature", "time", "attitude"};

std::string_view followed_name(criticism::live::Follows what) {
  return kFollowsNames.at(static_cast<std::size_t>(what));
}

std::string quantity(int component, bool cross) {
  constexpr std::array<const char*, 4> kOfCross{"the curl", "the centre's x", "the centre's y",
                                                "the centre's z"};
  return cross ? kOfCross.at(static_cast<std::size_t>(component))
               : fmt::format("closure number {}", component + 1);
}

const char* unit_of(int component, bool cross) { return cross && component == 0 ? "nT/m" : "nT"; }

std::string evidence_text(const criticism::live::FollowedQuantity& followed, bool cross) {
  const criticism::live::Following& f = followed.evidence;
  const char* const unit = unit_of(f.component, cross);
  const std::string evidence = fmt::format("{:.0f} % of what the closure does beyond its noise, {}",
                                           100 * f.share, stats::p_phrase(f.log10_p));
  if (followed.what == criticism::live::Follows::attitude) {
    return fmt::format(
        "{} follows the attitude: it moves by {:.3g} {} over the turns of the last {:.0f} min ({})",
        quantity(f.component, cross), f.swing, unit, followed.minutes, evidence);
  }
  return fmt::format("{} follows {} with {:.3g} +- {:.1g} {}/{}: {:.3g} {} in the last {:.0f} min ({})",
                     quantity(f.component, cross), followed_name(followed.what), f.slope, f.slope_sd, unit,
                     kPer.at(static_cast<std::size_t>(followed.what)), f.swing, unit, followed.minutes,
                     evidence);
}

LiveReport suspect_report(const criticism::live::FollowedQuantity& followed, bool cross) {
  LiveReport out{.state = criticism::live::LiveState::suspect, .measured = evidence_text(followed, cross)};
  for (const criticism::live::Follows other : followed.also)
    out.measured += fmt::format("; or it follows {}: they went together", followed_name(other));
  out.limit = fmt::format("{:.3g} {}, the standard deviation that the calibration states",
                          followed.evidence.stated_sd, unit_of(followed.evidence.component, cross));
  out.remedy = "measure a dozen poses and run: mgt check CAL.json RUN";
  return out;
}

std::string closure_text(const criticism::live::LargeClosure& large, bool cross) {
  if (cross)
    return fmt::format("{:.3g} nT/m (curl) and {:.3g}, {:.3g}, {:.3g} nT (centre)", large.closure[0],
                       large.closure[1], large.closure[2], large.closure[3]);
  return fmt::format("{:.3g} nT, root mean square of {} numbers",
                     large.closure.norm() / std::sqrt(static_cast<double>(large.closure.size())),
                     large.closure.size());
}

LiveReport near_source_report(const criticism::live::LargeClosure& large, bool cross) {
  std::string tested;
  for (const criticism::live::Follows what : large.tested)
    tested += fmt::format("{}{}", tested.empty() ? "" : " or ", followed_name(what));
  return {.state = criticism::live::LiveState::near_source,
          .measured =
              fmt::format("the closure is {}, mean of {:.0f} samples: {}; {}", closure_text(large, cross),
                          large.samples, stats::p_phrase(large.log10_p),
                          tested.empty() ? "whether it follows temperature, time or attitude is not known yet"
                                         : "it does not follow " + tested),
          .limit = "a chance of 1e-5 in 10 s, twice running, in an intact calibration and a smooth field",
          .remedy =
              "move the array, or what is magnetic, by some metres; if it stays, turn the array and run: "
              "mgt check CAL.json RUN"};
}

LiveReport rearranged_report(const criticism::tests::RearrangementFinding& found) {
  const std::string limit =
      found.dof == 4
          ? std::string("100, ten standard deviations")
          : fmt::format(
                "{:.0f}, the limit with the same rate of false alarms as 100 for four closure numbers",
                stats::chi_square_alike(100, 4, found.dof));
  const std::size_t others = found.possible.front().sensor.size() - 1;
  const std::string what = rearrangement_text(found.possible);
  if (found.turned()) {
    return {.state = criticism::live::LiveState::turned,
            .measured =
                fmt::format("{}: the closure has a chi-square of {:.2g} ({} degrees of freedom), and "
                            "turned so the sensor reads the field of the other {} to {:.0f} %",
                            what, found.chi2, found.dof, others == 3 ? "three" : fmt::format("{}", others),
                            100 * criticism::tests::kTurnAgreement),
            .limit = limit,
            .remedy = "turn the sensor back, or calibrate anew as it stands"};
  }
  return {.state = criticism::live::LiveState::exchanged,
          .measured =
              fmt::format("{}: the closure has a chi-square of {:.2g} ({} degrees of freedom), and below "
                          "{:.0f} when their readings are taken so",
                          what, found.chi2, found.dof, criticism::tests::explained_closure_chi2(found.dof)),
          .limit = limit,
          .remedy =
              "swap the plugs back, of the digitisers or of the sensors behind them, or exchange the ports "
              "in the configuration"};
}

}  // namespace

LiveReport live_report(const criticism::live::LiveFinding& found,
                       const std::optional<criticism::tests::RearrangementFinding>& rearranged) {
  if (rearranged) return rearranged_report(*rearranged);
  if (found.state == criticism::live::LiveState::suspect && found.followed)
    return suspect_report(*found.followed, found.cross);
  if (found.state == criticism::live::LiveState::near_source && found.large)
    return near_source_report(*found.large, found.cross);
  return {.state = found.state};
}

}  // namespace mgtd::calib::report
