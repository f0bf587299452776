// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "daemon/acquire/sampler.h"

namespace mgtd::daemon::acquire {
namespace {

constexpr std::size_t kReferenceIndex = 0;
constexpr double kApart_s = 1e-6;            // epochs are, at least
constexpr double kMaxUninterpolated = 0.02;  // periods before the first sample

}  // namespace

void Sampler::Pick::take(const Sample& sample) {
  y_nT = sample.y_nT;
  flags |= sample.flags;
  doubt_s = std::max({doubt_s, sample.doubt_s, sample.late_s});
}

/// The sample of one sensor at t: its nearest when that is near enough, else between its two neighbours.
Sampler::Pick Sampler::pick(int slot, double t_s) const {
  const Stream& s = streams_[static_cast<std::size_t>(slot)];
  Pick to;
  if (s.clock.empty()) return to;
  const double u = s.clock.index_of(t_s);
  const double below = std::floor(u);
  if (u < static_cast<double>(s.first_k) - kMaxUninterpolated) {
    to.need = Need::not_yet;
    return to;
  }
  const auto need = [&](std::int64_t k) {
    return s.find(k) != nullptr ? Need::ready : k > s.last_k ? Need::wait : Need::lost;
  };
  const double nearest = std::round(u), shift_s = (nearest - u) * s.clock.period_s();
  if (std::abs(shift_s) <= config_.negligible_shift * period_s_) {
    const auto k = static_cast<std::int64_t>(nearest);
    to.need = need(k);
    if (to.need != Need::ready) return to;
    const Sample* sample = s.find(k);
    to.shift_s = shift_s;
    to.take(*sample);
    return to;
  }
  const auto k = static_cast<std::int64_t>(below);
  const Need left = need(k), right = need(k + 1);
  to.need = left == Need::ready ? right : left;
  if (to.need != Need::ready) return to;
  const Sample *p = s.find(k), *q = s.find(k + 1);
  to.interpolated = true;
  to.take(*p);
  to.take(*q);
  to.y_nT = p->y_nT + (u - below) * (q->y_nT - p->y_nT);
  to.flags |= Flag::interpolated;
  return to;
}

/// One step along the grid. False: a sample is still on its way.
bool Sampler::emit_next(std::vector<EpochOrGap>& out) {
  const Sample* own = streams_[kReferenceIndex].find(next_k_);
  if (own == nullptr) {
    emit_gap(1, kReferenceIndex, next_k_ < streams_[kReferenceIndex].first_k ? Why::not_yet : Why::lost, out);
    return true;
  }
  const double t_s = grid_time(next_k_);
  PerSensor<Pick> picks(streams_.size());
  picks[kReferenceIndex].need = Need::ready;
  picks[kReferenceIndex].take(*own);
  int waiting = -1;
  for (int slot = 1; slot < static_cast<int>(streams_.size()); ++slot) {
    Pick& p = picks[static_cast<std::size_t>(slot)];
    p = pick(slot, t_s);
    if (p.need == Need::lost || p.need == Need::not_yet) {
      emit_gap(1, slot, p.need == Need::lost ? Why::lost : Why::not_yet, out);
      return true;
    }
    if (p.need == Need::wait) waiting = slot;
  }
  if (waiting >= 0) {
    if (own->arrival_s + config_.silence_s >= now_s_) return false;
    emit_gap(1, waiting, Why::silent, out);
    return true;
  }
  if (t_s < last_t_s_ + kApart_s) {
    emit_gap(1, kReferenceIndex, Why::clock, out);
  } else {
    emit_epoch(t_s, picks, out);
  }
  return true;
}

void Sampler::emit_ready(std::vector<EpochOrGap>& out) {
  while (next_k_ <= streams_[kReferenceIndex].last_k && emit_next(out)) {
  }
}

/// Without the reference there is no grid: its absence is counted by its last known period.
void Sampler::emit_silent_reference(std::vector<EpochOrGap>& out) {
  const Stream& s = streams_[kReferenceIndex];
  const double since_s = now_s_ - config_.silence_s;
  if (next_k_ <= s.last_k || s.last_arrival_s > since_s) return;
  const auto until = static_cast<std::int64_t>(std::floor(grid_index(since_s)));
  if (until >= next_k_) emit_gap(until - next_k_ + 1, kReferenceIndex, Why::silent, out);
}

void Sampler::emit_epoch(double t_s, const PerSensor<Pick>& picks, std::vector<EpochOrGap>& out) {
  flush_gap(out);
  out.emplace_back(std::in_place_type<Epoch>);
  Epoch& epoch = *std::get_if<Epoch>(&out.back());
  epoch.seq = next_seq_++;
  epoch.t = stamp(t_s);
  epoch.T_degC = temperatures(epoch.t.mono);
  epoch.y_nT.resize(streams_.size());
  PerSensor<ClockModel::Bound> off(streams_.size());
  for (std::size_t i = 0; i < off.size(); ++i) {
    const Stream& s = streams_[i];
    off[i] = s.clock.bound(s.clock.index_of(t_s));
    off[i].early_s += picks[i].doubt_s + std::max(0.0, -picks[i].shift_s);
    off[i].late_s += picks[i].doubt_s + std::max(0.0, picks[i].shift_s);
    epoch.y_nT[i] = picks[i].y_nT;
    epoch.flags |= picks[i].flags;
    if (picks[i].doubt_s > 0 || !s.clock.settled() || s.clock.contested())
      epoch.flags |= Flag::clock_unsettled;
  }
  for (std::size_t i = 0; i < off.size(); ++i) {
    for (std::size_t j = 0; j < off.size(); ++j) {
      if (i != j) epoch.skew_bound_s = std::max(epoch.skew_bound_s, off[i].late_s + off[j].early_s);
    }
  }
  last_t_s_ = t_s;
  ++next_k_;
  ++epochs_;
}

void Sampler::emit_gap(std::int64_t count, int slot, Why why, std::vector<EpochOrGap>& out) {
  const auto n = static_cast<std::uint64_t>(count);
  if (open_gap_ && (open_slot_ != slot || open_why_ != why)) flush_gap(out);
  if (!open_gap_) {
    static constexpr std::array<const char*, 4> kWhy{"frame lost", "silent", "not measuring yet",
                                                     "clock set back"};
    const double t_s = grid_time(next_k_);
    open_gap_ = Gap{next_seq_, next_seq_, stamp(t_s),
                    fmt::format("s{}: {}", slot + 1, kWhy[static_cast<std::size_t>(why)])};
    open_since_s_ = now_s_;
    open_slot_ = slot;
    open_why_ = why;
  }
  next_k_ += count;
  next_seq_ += n;
  gaps_ += n;
  open_gap_->to_seq = next_seq_ - 1;
  streams_[static_cast<std::size_t>(slot)].health.gaps += n;
}

void Sampler::flush_gap(std::vector<EpochOrGap>& out) {
  if (!open_gap_) return;
  out.emplace_back(std::move(*open_gap_));
  open_gap_.reset();
}

Stamp Sampler::stamp(double t_s) const {
  const Duration since = from_seconds(t_s);
  return {origin_ + since, WallTime{origin_wall_ns_ + since.count()}};
}

}  // namespace mgtd::daemon::acquire
