// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/live/live_criticism.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "calib/stats/probability.h"

namespace mgtd::calib {
namespace {

constexpr double kAlarm_log10 = -8;  // 10 000 looks a day at correlated data: far below one false alarm a day
constexpr double kNear_log10 = -5;   // in two blocks running: one burst of noise is no source
constexpr double kCalm_log10 = -3;
constexpr double kBeyond_chi2 = 100;            // of four quantities, of one sample
constexpr double kBeyondTurn = 5;               // closure over what a turn may add to it
constexpr int kCalmBlocks = 6, kLookEvery = 6;  // blocks of 10 s
constexpr double kLeastShare = 0.5,
                 kLeastSwing = 1;  // swing in standard deviations that the calibration states
constexpr double kAmbiguousShare = 0.1, kEventMargin = 0.02;
constexpr double kHourBlock_s = 10, kDayBlock_s = 600;
constexpr std::size_t kHourBlocks = 360, kDayBlocks = 144, kLearned = 6;

constexpr std::array<const char*, 4> kQuantity{"the curl", "the centre's x", "the centre's y",
                                               "the centre's z"};
constexpr std::array<const char*, 2> kPer{"degC", "h"};

const char* unit_of(int component) { return component == 0 ? "nT/m" : "nT"; }

/// A turn is an event too, so that the attitude may explain as much as one.
bool is_followed(const Following& f, Follows what) {
  const double least = f.event_share - (what == Follows::attitude ? kEventMargin : -kEventMargin);
  return f.tested && f.share >= least && f.log10_p < kAlarm_log10 && f.share >= kLeastShare &&
         f.swing > kLeastSwing * f.stated_sd;
}

std::string described(const Following& f, Follows what, double minutes) {
  const auto at = static_cast<std::size_t>(f.component);
  const char* const unit = unit_of(f.component);
  const std::string name(kFollowsNames.at(static_cast<std::size_t>(what)));
  const std::string evidence = fmt::format("{:.0f} % of what the closure does beyond its noise, {}",
                                           100 * f.share, p_phrase(f.log10_p));
  if (what == Follows::attitude) {
    return fmt::format(
        "{} follows the attitude: it moves by {:.3g} {} over the turns of the last {:.0f} min ({})",
        kQuantity.at(at), f.swing, unit, minutes, evidence);
  }
  return fmt::format("{} follows {} with {:.3g} +- {:.1g} {}/{}: {:.3g} {} in the last {:.0f} min ({})",
                     kQuantity.at(at), name, f.slope, f.slope_sd, unit,
                     kPer.at(static_cast<std::size_t>(what)), f.swing, unit, minutes, evidence);
}

}  // namespace

std::string_view to_string(LiveState state) {
  static constexpr std::array<std::string_view, 7> kNames{"none",        "learning",  "ok",    "suspect",
                                                          "near source", "exchanged", "turned"};
  return kNames.at(static_cast<std::size_t>(state));
}

LiveCriticism::Judges::Judges(const ClosurePrior& p)
    : prior(p),
      least_noise_nT(std::sqrt(p.sample_noise.diagonal().tail<3>().minCoeff())),
      hour(kHourBlock_s, kHourBlocks, p),
      day(kDayBlock_s, kDayBlocks, p) {}

LiveCriticism::LiveCriticism(const Calibration& calibration) {
  if ((calibration.sample_noise_nT.array() <= 0).any()) return;
  judges_.emplace(closure_prior(calibration));
  finding_.state = LiveState::learning;
}

double LiveCriticism::turn_nT(const TensorSample& sample) {
  const double t_s = to_seconds(sample.t.mono.time_since_epoch());
  double turn_nT = 0;
  if (last_ && t_s > last_->first) {
    const double rate_nT_per_s = (sample.b_P_nT - last_->second).norm() / (t_s - last_->first);
    // The noise of two samples is no turn.
    const double noise_rate = 4 * judges_->least_noise_nT / (t_s - last_->first);
    turn_nT = std::max(0.0, rate_nT_per_s - noise_rate) * sample.skew_bound_s;
  }
  last_.emplace(t_s, sample.b_P_nT);
  return turn_nT;
}

bool LiveCriticism::add(const TensorSample& sample, const std::array<double, kSensors>& T_degC) {
  beyond_.reset();
  if (!judges_) return false;
  const double turned_nT = turn_nT(sample);
  for (const Flag wrong : {Flag::saturated, Flag::frozen, Flag::incomplete}) {
    if (sample.flags.has(wrong)) return false;
  }
  const Closure& c = sample.closure;
  const Eigen::Vector4d closure(c.curl_nT_per_m, c.center_nT[0], c.center_nT[1], c.center_nT[2]);
  const bool large = c.chi2 > kBeyond_chi2;
  if (!large || closure.norm() > kBeyondTurn * turned_nT) beyond_ = large;
  if (turned_nT > judges_->least_noise_nT / 2) return false;
  double sum = 0;
  for (const double T : T_degC) sum += T;
  return add({to_seconds(sample.t.mono.time_since_epoch()), closure, sample.b_P_nT, sum / kSensors});
}

bool LiveCriticism::add(const ClosureSample& sample) {
  if (!judges_) return false;
  const bool ten_seconds = judges_->hour.add(sample), ten_minutes = judges_->day.add(sample);
  if (!ten_seconds && !ten_minutes) return false;
  if (ten_minutes) judge(judges_->day);
  if (ten_seconds) {
    if (--until_look_ <= 0) {
      judge(judges_->hour);
      until_look_ = judges_->hour.blocks().size() < 2 * kLearned ? 1 : kLookEvery;
    }
    if (judges_->hour.blocks().size() >= kLearned)
      judge_nearness(block_log10_p(judges_->hour.blocks().back(), judges_->prior, noise_scale_));
  }
  const LiveState before = finding_.state;
  finding_.state = state();
  finding_.measured = !followed_hour_.empty()  ? followed_hour_
                      : !followed_day_.empty() ? followed_day_
                                               : near_;
  finding_.limit = !followed_hour_.empty() ? limit_hour_ : limit_day_;
  finding_.remedy.clear();
  if (finding_.state == LiveState::suspect)
    finding_.remedy = "measure a dozen poses and run: mgt check CAL.json RUN";
  if (finding_.state == LiveState::near_source) {
    finding_.limit = "a chance of 1e-5 in 10 s, twice running, in an intact calibration and a smooth field";
    finding_.remedy =
        "move the array, or what is magnetic, by some metres; if it stays, turn the array and run: mgt check "
        "CAL.json RUN";
  }
  return finding_.state != before;
}

void LiveCriticism::judge(const LiveWindow& window) {
  const bool hour = &window == &judges_->hour;
  std::string &followed = hour ? followed_hour_ : followed_day_, &limit = hour ? limit_hour_ : limit_day_;
  if (window.blocks().empty()) return;
  const WindowCriticism found = criticise(window.blocks(), judges_->prior);
  if (hour) {
    noise_scale_ = found.noise_scale;
    tested_.clear();
    for (std::size_t k = 0; k < found.follows.size(); ++k) {
      if (found.follows.at(k).tested)
        tested_ += (tested_.empty() ? "" : " or ") + std::string(kFollowsNames.at(k));
    }
  }
  followed.clear();
  std::size_t best = found.follows.size();
  for (std::size_t k = 0; k < found.follows.size(); ++k) {
    if (is_followed(found.follows.at(k), static_cast<Follows>(k)) &&
        (best == found.follows.size() || found.follows.at(k).share > found.follows.at(best).share))
      best = k;
  }
  if (best < found.follows.size()) {
    const Following& f = found.follows.at(best);
    const double minutes = (window.blocks().back().t_s - window.blocks().front().t_s) / 60;
    followed = described(f, static_cast<Follows>(best), minutes);
    limit = fmt::format("{:.3g} {}, the standard deviation that the calibration states", f.stated_sd,
                        unit_of(f.component));
    for (std::size_t k = 0; k < found.follows.size(); ++k) {
      if (k != best && is_followed(found.follows.at(k), static_cast<Follows>(k)) &&
          found.follows.at(k).share > f.share - kAmbiguousShare)
        followed += fmt::format("; or it follows {}: they went together", kFollowsNames.at(k));
    }
  }
}

void LiveCriticism::judge_nearness(double log10_p) {
  const bool large = log10_p < kNear_log10;
  if (large && (large_before_ || !near_.empty())) {
    const ClosureBlock& b = judges_->hour.blocks().back();
    near_ = fmt::format(
        "the closure is {:.3g} nT/m (curl) and {:.3g}, {:.3g}, {:.3g} nT (centre), mean of {:.0f} samples: "
        "{}; {}",
        b.closure[0], b.closure[1], b.closure[2], b.closure[3], b.samples, p_phrase(log10_p),
        tested_.empty() ? "whether it follows temperature, time or attitude is not known yet"
                        : "it does not follow " + tested_);
    calm_blocks_ = 0;
  } else if (log10_p > kCalm_log10 && !near_.empty() && ++calm_blocks_ >= kCalmBlocks) {
    near_.clear();
  }
  large_before_ = large;
}

LiveState LiveCriticism::state() const {
  if (!followed_hour_.empty() || !followed_day_.empty()) return LiveState::suspect;
  if (!near_.empty()) return LiveState::near_source;
  return judges_->hour.blocks().size() >= kLearned ? LiveState::ok : LiveState::learning;
}

}  // namespace mgtd::calib
