// SPDX-License-Identifier: Apache-2.0
#include "calib/report/explain_note_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "calib/fit/checks/check_limits.h"
#include "calib/fit/checks/mirrored_text.h"
#include "calib/report/fit_reasons.h"
#include "calib/report/rearrangement_text.h"
#include "calib/report/size_text.h"
#include "calib/stats/probability.h"
#include "proto/units.h"

namespace mgtd::calib::report {
namespace {

std::string text(const criticism::search::SensorsMirrored& n) {
  return fit::checks::mirrored_text(n.sensors, n.of);
}

std::string text(const criticism::search::TableAnglesContradict& n) {
  return fmt::format(
      "the table angles contradict the readings by {:.1f} degrees a pose where {:.0f} is the limit: sense "
      "or order of the angles, or a mounting written down wrongly",
      to_deg(n.sd_rad), to_deg(n.limit_rad));
}

std::string text(const criticism::search::TableAnglesRough& n) {
  return rough_table_text(n.estimated_rad, n.stated_rad);
}

std::string text(const criticism::search::PosesContradict& n) {
  return fmt::format("readings in {:.0f} % of the poses contradict the rest; the limit is {:.0f} %",
                     100 * n.share, 100 * fit::checks::kMaxBadPoses);
}

std::string text(const criticism::search::NoiseOverstated& n) {
  return fmt::format(
      "{} scatters only {:.2f} of what its noise says: spreads or counts in the table are "
      "wrong, or poses are copies",
      n.channel, n.residual_ratio);
}

std::string text(const criticism::search::ResidualWithoutLaw& n) {
  return fmt::format(
      "the residual is {:.2g} times the noise, {:.3g} nT rms where its median tells {:.3g} nT, and {:.0f} % "
      "of the poses contradict the others: look for a loose cable or a disturbance, and measure again",
      n.noise_inflation, n.residual_nT, n.typical_nT, 100 * n.contradicting);
}

std::string text(const criticism::search::SensorsExchanged& n) { return exchange_text(n.exchange); }

std::string text(const criticism::search::TablePathUnknown&) {
  return "the way of the table between its poses is not in these data: a memory of the cores is followed "
         "from "
         "dwell to dwell only, its size and its width are rough, and what is there may be one "
         "(axis.hysteresis) under another name or without any. To settle it: measure with the daemon, whose "
         "run file keeps the angles of the table on the way, or go to a dozen of the poses from both sides";
}

std::string text(const criticism::search::ExcessRemains& n) {
  return fmt::format("{} accounts for {:.0f} % of the excess only", n.effect, 100 * n.share);
}

std::string text(const criticism::search::FallNotAsPredicted& n) {
  return fmt::format("chi-square fell by {:.0f} where {:.0f} was predicted", n.realised, n.predicted);
}

std::string text(const criticism::search::LackOfFitRemains& n) {
  return fmt::format("{} is not all of it: with it {} still differs from noise, {}", n.effect, n.where,
                     stats::p_phrase(n.log10_p));
}

std::string text(const criticism::search::SizeTooSmall& n) {
  return fmt::format("{} is {:.1f} sigma large, too little to say that no other law is behind the sum",
                     n.effect, n.d);
}

std::string text(const criticism::search::StepsFollowCurve&) {
  return "several steps or thresholds on one axis follow a smooth curve: they are not evidence of steps";
}

std::string text(const criticism::search::EvidenceOfOnePose& n) {
  return fmt::format("one pose ({}) carries the evidence for {}: measure it again", n.pose, n.effect);
}

std::string text(const criticism::search::FitWithEffectFailed& n) {
  return fmt::format("the fit with {} failed: {}", n.spec, n.why);
}

std::string text(const criticism::search::SizeUnusual& n) {
  return fmt::format("the size of {}, {}, is larger than is usual", n.candidate.effect,
                     size_text(n.candidate));
}

std::string text(const criticism::search::SizeBeyondAll& n) {
  return fmt::format("{} is not named: it would have to be {}, larger than ever occurs", n.candidate.effect,
                     size_text(n.candidate));
}

std::string text(const criticism::search::DescribesRecording& n) {
  const char* them = n.effects.size() == 1 ? "it" : "them";
  if (n.curve) {
    return fmt::format(
        "{} would lower the residual from {:.3g} to {:.3g} nT, but as steps that follow a curve: in a "
        "recording of single samples that does not name {}",
        fmt::join(n.effects, ", "), n.before_nT, n.after_nT, them);
  }
  return fmt::format(
      "{} would lower the residual from {:.3g} to {:.3g} nT only, and what is left still differs from noise: "
      "in a recording of single samples that is too little to name {}",
      fmt::join(n.effects, ", "), n.before_nT, n.after_nT, them);
}

std::string text(const criticism::search::LostInWandering& n) {
  return fmt::format(
      "{} stood out in {} ({:.1f} sigma), but the fit, whose uncertainties contain the wandering, "
      "does not find it ({}): it is not named",
      n.effect, n.where, n.d, stats::p_phrase(n.log10_p_of_fit));
}

std::string text(const criticism::search::TookLittle& n) {
  return fmt::format(
      "{} ({}) is not named: it lowers the residual from {:.3g} to {:.3g} nT only, and with so much "
      "unexplained {:.1f} sigma come about by chance",
      n.effect, n.where, n.before_nT, n.after_nT, n.d);
}

std::string text(const criticism::search::FarAboveNoise& n) {
  return fmt::format(
      "the residual stays at {:.3g} nT, far above the noise of {:.3g} nT: what else is there has no shape "
      "that a test here sees",
      n.residual_nT, n.noise_nT);
}

std::string text(const criticism::search::LawOfNoLibrary& n) {
  const std::string what = fmt::format("{} follows something that is in no library", n.where);
  if (n.effects.empty()) return what;
  const bool one = n.effects.size() == 1;
  return fmt::format("{}: {} {}, so {} named or added", what, fmt::join(n.effects, ", "),
                     one ? "describes it and is not its cause" : "describe it together and are not its cause",
                     one ? "it is not" : "none of them is");
}

}  // namespace

std::string to_text(const criticism::search::ExplainNote& note) {
  return std::visit([](const auto& n) { return text(n); }, note);
}

std::vector<std::string> note_texts(const std::vector<criticism::search::ExplainNote>& notes) {
  std::vector<std::string> out;
  for (const criticism::search::ExplainNote& note : notes) {
    std::string words = to_text(note);
    if (std::find(out.begin(), out.end(), words) == out.end()) out.push_back(std::move(words));
  }
  return out;
}

}  // namespace mgtd::calib::report
