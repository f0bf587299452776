// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/live/live_criticism.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "calib/calibration/tensor.h"
#include "calib/stats/chi_square.h"

namespace mgtd::calib::criticism::live {
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

/// A turn is an event too, so that the attitude may explain as much as one.
bool is_followed(const Following& f, Follows what) {
  const double least = f.event_share - (what == Follows::attitude ? kEventMargin : -kEventMargin);
  return f.tested && f.share >= least && f.log10_p < kAlarm_log10 && f.share >= kLeastShare &&
         f.swing > kLeastSwing * f.stated_sd;
}

/// The quantity that explains most, if any does.
std::optional<FollowedQuantity> followed_in(const WindowCriticism& found, double minutes) {
  constexpr std::array kFollowable{Follows::temperature, Follows::time, Follows::attitude};
  const auto of = [&](Follows what) -> const Following& {
    return found.follows.at(static_cast<std::size_t>(what));
  };
  std::optional<FollowedQuantity> out;
  for (const Follows what : kFollowable) {
    if (is_followed(of(what), what) && (!out || of(what).share > out->evidence.share))
      out = {what, of(what), minutes, {}};
  }
  if (!out) return out;
  for (const Follows what : kFollowable) {
    if (what != out->what && is_followed(of(what), what) &&
        of(what).share > out->evidence.share - kAmbiguousShare)
      out->also.push_back(what);
  }
  return out;
}

}  // namespace

LiveCriticism::Judges::Judges(const ClosurePrior& p)
    : prior(p),
      least_noise_nT(std::sqrt(p.sample_noise.diagonal().tail(p.numbers() - (p.cross ? 1 : 0)).minCoeff())),
      beyond_chi2(stats::chi_square_alike(kBeyond_chi2, 4, static_cast<double>(p.numbers()))),
      hour(kHourBlock_s, kHourBlocks, p),
      day(kDayBlock_s, kDayBlocks, p) {}

LiveCriticism::LiveCriticism(const calibration::Calibration& calibration) {
  if ((calibration.sample_noise_nT.array() <= 0).any()) return;
  if (calibration::closure_rows(calibration.geometry).rows() == 0) return;
  judges_.emplace(closure_prior(calibration));
  finding_.state = LiveState::learning;
  finding_.cross = judges_->prior.cross;
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

bool LiveCriticism::add(const TensorSample& sample, const PerSensor<double>& T_degC) {
  beyond_.reset();
  if (!judges_) return false;
  const double turned_nT = turn_nT(sample);
  for (const Flag wrong : {Flag::saturated, Flag::frozen, Flag::incomplete}) {
    if (sample.flags.has(wrong)) return false;
  }
  const Closure& c = sample.closure;
  const sensor::FieldVector closure = calibration::closure_numbers(c);
  const bool large = c.chi2 > judges_->beyond_chi2;
  if (!large || closure.norm() > kBeyondTurn * turned_nT) beyond_ = large;
  if (turned_nT > judges_->least_noise_nT / 2) return false;
  double sum = 0;
  for (const double T : T_degC) sum += T;
  return add({to_seconds(sample.t.mono.time_since_epoch()), closure, sample.b_P_nT,
              sum / static_cast<double>(T_degC.size())});
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
  finding_.followed = followed_hour_ ? followed_hour_ : followed_day_;
  finding_.large = near_;
  return finding_.state != before;
}

void LiveCriticism::judge(const LiveWindow& window) {
  const bool hour = &window == &judges_->hour;
  if (window.blocks().empty()) return;
  const WindowCriticism found = criticise(window.blocks(), judges_->prior);
  if (hour) {
    noise_scale_ = found.noise_scale;
    tested_.clear();
    for (std::size_t k = 0; k < found.follows.size(); ++k)
      if (found.follows.at(k).tested) tested_.push_back(static_cast<Follows>(k));
  }
  const double minutes = (window.blocks().back().t_s - window.blocks().front().t_s) / 60;
  (hour ? followed_hour_ : followed_day_) = followed_in(found, minutes);
}

void LiveCriticism::judge_nearness(double log10_p) {
  const bool large = log10_p < kNear_log10;
  if (large && (large_before_ || near_)) {
    const ClosureBlock& b = judges_->hour.blocks().back();
    near_ = {b.closure, b.samples, log10_p, tested_};
    calm_blocks_ = 0;
  } else if (log10_p > kCalm_log10 && near_ && ++calm_blocks_ >= kCalmBlocks) {
    near_.reset();
  }
  large_before_ = large;
}

LiveState LiveCriticism::state() const {
  if (followed_hour_ || followed_day_) return LiveState::suspect;
  if (near_) return LiveState::near_source;
  return judges_->hour.blocks().size() >= kLearned ? LiveState::ok : LiveState::learning;
}

}  // namespace mgtd::calib::criticism::live
