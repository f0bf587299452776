// SPDX-License-Identifier: Apache-2.0
#include "daemon/acquire/sampler.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace mgtd::daemon::acquire {
namespace {

constexpr int kReference = 0;
constexpr double kImpossiblyEarly = 0.5;    // periods before the model's sample time
constexpr double kPrompt = 0.2;             // periods of mean delay: lost frames can be counted by time
constexpr std::int64_t kMerged = 2;         // frames that garbage can hide in one rejected line
constexpr std::int64_t kConfirmed = 64;     // samples on time after a loss
constexpr int kProved = 16;                 // where delivery is never prompt
constexpr double kAgree = 0.3;              // periods between count and time
constexpr double kEarly = 0.1;              // periods before the line
constexpr double kIdle = 0.9;               // periods since the last sample: nothing waits in the line ...
constexpr int kPromptInARow = 2;            // ... unless that one line was a long one
constexpr double kNotYet = 0.7;             // periods since the last sample: no new one can be
constexpr std::int64_t kOvertaken = 8;      // samples that a late one may come behind
constexpr double kLate = 0.9;               // periods behind it, or ...
constexpr double kLateResiduals = 2.5;      // ... so many of the usual delays ...
constexpr double kLatest = 2;               // ... that are not themselves lateness
constexpr std::uint64_t kLateSamples = 16;  // all late, and spread in time: frames were lost unseen
constexpr double kDrains = 0.25;            // periods less late than before: a backlog
constexpr double kHoldGap_s = 1.0;          // before a gap is told, so that a long one is one record
constexpr double kNoDoubt_s = 1e9;
constexpr double kRing_s = 16.0;  // of samples kept: a stalled host delivers so much at once

std::int64_t whole(double x) { return static_cast<std::int64_t>(std::llround(x)); }

}  // namespace

const Sampler::Sample* Sampler::Stream::find(std::int64_t k) const {
  if (k < first_k || k > last_k) return nullptr;
  const Sample& sample = ring[static_cast<std::size_t>(k) & (ring.size() - 1)];
  return sample.k == k ? &sample : nullptr;
}

template <class Do>
void Sampler::Stream::for_each_from(std::int64_t from, const Do& act) {
  const auto capacity = static_cast<std::int64_t>(ring.size());
  for (std::int64_t k = last_k; k >= std::max(from, last_k - capacity + 1); --k) {
    Sample& sample = ring[static_cast<std::size_t>(k) & (ring.size() - 1)];
    if (sample.k == k) act(sample);
  }
}

void Sampler::Stream::renumber(std::int64_t from, std::int64_t by) {
  for_each_from(from, [&](Sample& sample) {
    Sample moved = sample;
    sample.k = -1;
    moved.k += by;
    ring[static_cast<std::size_t>(moved.k) & (ring.size() - 1)] = moved;
  });
  last_k += by;
}

void Sampler::Stream::lessen_lateness(std::int64_t from, double by_s) {
  for_each_from(from, [&](Sample& sample) { sample.late_s = std::max(0.0, sample.late_s - by_s); });
}

void Sampler::Stream::prove(std::int64_t from) {
  for_each_from(from, [](Sample& sample) { sample.doubt_s = 0; });
}

Sampler::Sampler(SamplerConfig config) : config_(config), period_s_(1 / config.rate_hz) {
  const double kept = std::max(kRing_s, 4 * config.silence_s) * config.rate_hz + 64;
  const std::size_t capacity = std::bit_ceil(static_cast<std::size_t>(kept));
  for (const double step_s : config.step_s) {
    streams_.emplace_back(ClockModel({.period_s = period_s_,
                                      .step_s = step_s,
                                      .scheduling_s = config.scheduling_s,
                                      .max_drift = config.max_drift,
                                      .longest_wait_s = config.silence_s,
                                      .settle_samples = config.settle_samples}),
                          capacity);
  }
  T_degC_.assign(streams_.size(), std::numeric_limits<double>::quiet_NaN());
  T_at_.resize(streams_.size());
  next_seq_ = config_.first_seq;
}

void Sampler::begin(const Stamp& stamp) {
  if (!begun_) {
    begun_ = true;
    origin_ = stamp.mono;
    grid_ = {0, 0, period_s_};
    last_t_s_ = -std::numeric_limits<double>::infinity();
  }
  now_s_ = std::max(now_s_, seconds(stamp.mono));
}

void Sampler::push(const FieldReading& reading, std::vector<EpochOrGap>& out) {
  const auto slot = static_cast<std::size_t>(reading.slot);
  if (slot >= streams_.size()) return;
  begin(reading.arrival);
  origin_wall_ns_ = reading.arrival.wall.ns - (reading.arrival.mono - origin_).count();
  Stream& s = streams_[slot];
  const double arrival_s = seconds(reading.arrival.mono);
  const double sample_s = arrival_s - config_.wire_s[slot] - config_.latency_s[slot];
  const double since_last_s = arrival_s - std::exchange(s.last_arrival_s, arrival_s);
  const auto numbered =
      s.last && comes_again(s, reading, sample_s) ? std::nullopt : number(reading.slot, reading, sample_s);
  if (!numbered) {
    ++s.health.duplicates;
    s.last->seq = std::max(s.last->seq, reading.seq);
    return;
  }
  s.last = reading;
  const std::int64_t k = *numbered;
  // A number in doubt must not teach the clock that samples come earlier.
  const double early_s = s.clock.time_of(static_cast<double>(k)) - sample_s;
  if (s.doubtful == 0 || early_s < kEarly * period_s_) s.clock.add(k, sample_s);
  if (s.doubtful > 0) s.clock.distrust();
  if (reading.y_nT.allFinite()) {
    Flags flags = reading.flags;
    if (s.repeats.stands_still(reading.y_nT)) flags |= Flag::frozen;
    s.ring[static_cast<std::size_t>(k) & (s.ring.size() - 1)] = {
        k, arrival_s, reading.y_nT, flags, static_cast<double>(s.doubtful) * period_s_, 0};
  }
  s.last_k = k;
  ++s.health.samples;
  const double delay_s = sample_s - s.clock.time_of(static_cast<double>(k));
  watch_lateness(s, arrival_s, delay_s);
  watch_doubt(s, since_last_s, delay_s);
  // The next bytes may tell; the next tick at the latest ends the wait.
  if (!in_doubt()) emit_ready(out);
}

void Sampler::push(const TemperatureReading& reading) {
  const auto slot = static_cast<std::size_t>(reading.slot);
  if (slot >= streams_.size() || !reading.sensor_degC) return;
  T_degC_[slot] = *reading.sensor_degC;
  T_at_[slot] = reading.arrival.mono;
}

PerSensor<double> Sampler::temperatures(Instant at) const {
  PerSensor<double> out = T_degC_;
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (to_seconds(at - T_at_[i]) > config_.temperature_s) out[i] = std::numeric_limits<double>::quiet_NaN();
  }
  return out;
}

void Sampler::reopened(int slot) {
  const auto i = static_cast<std::size_t>(slot);
  if (i >= streams_.size() || !streams_[i].last) return;
  ++streams_[i].health.reopened;
  restart(slot);
}

/// The count starts over. The reference keeps its place in time: epochs lost meanwhile are counted by the
/// clock.
void Sampler::restart(int slot) {
  Stream& s = streams_[static_cast<std::size_t>(slot)];
  if (slot == kReference && !s.clock.empty()) {
    const auto k = static_cast<double>(s.last_k);
    grid_ = {k, s.clock.time_of(k), s.clock.period_s()};
  }
  s.clock.reset();
  s.last.reset();
  s.late = {};
  s.doubtful = 0;
}

std::int64_t Sampler::first_number(int slot, double sample_s) const {
  const Stream& s = streams_[static_cast<std::size_t>(slot)];
  if (slot != kReference) return s.last_k + 1;
  return std::max({s.last_k + 1, next_k_, whole(grid_.k + (sample_s - grid_.t_s) / grid_.period_s)});
}

/// Number of this sample in its stream; frames lost before it are counted. Empty: the number is taken, drop
/// the sample.
std::optional<std::int64_t> Sampler::number(int slot, const FieldReading& reading, double sample_s) {
  Stream& s = streams_[static_cast<std::size_t>(slot)];
  if (s.last && reading.seq < s.last->seq) {
    ++s.health.reopened;
    restart(slot);
  }
  if (s.last) {
    if (const Step step = this->step(s, reading, sample_s); step.by > 0) {
      count_lost(s, step.by - 1);
      if (step.doubtful > 0) {
        s.doubtful = std::max(s.doubtful, step.doubtful);
        s.prompt = s.in_time = 0;
        s.doubtful_since = s.last_k + step.by;
      }
      return s.last_k + step.by;
    }
    if (was_overcounted(s, sample_s)) return std::nullopt;
    ++s.health.clock_breaks;
    restart(slot);
  }
  s.first_k = first_number(slot, sample_s);
  return s.first_k;
}

void Sampler::count_lost(Stream& s, std::int64_t frames) const {
  s.health.lost += static_cast<std::uint64_t>(frames);
  if (frames == 0 && s.last_k - s.inserted_at < kConfirmed) return;
  s.inserted = frames;
  s.inserted_at = s.last_k;
}

/// Garbage can look like more frames than were lost: then the next sample comes a period before its number is
/// due.
bool Sampler::was_overcounted(Stream& s, double sample_s) const {
  const double early = (s.clock.time_of(static_cast<double>(s.last_k + 1)) - sample_s) / period_s_;
  if (s.inserted < 1 || early > static_cast<double>(s.inserted) + kImpossiblyEarly) return false;
  --s.inserted;
  s.doubtful_since = s.last_k + 1;  // those before had it
  // Nothing is interpolated across a sample that is dropped.
  s.ring[static_cast<std::size_t>(s.last_k) & (s.ring.size() - 1)].k = -1;
  return true;
}

/// The same sample once more, or one whose successor came first. Without a time of its own a sample is the
/// last one again when it reads the same and there was no time for another.
bool Sampler::comes_again(const Stream& s, const FieldReading& reading, double sample_s) const {
  if (reading.seq == s.last->seq) return true;
  if (reading.device_time_s && s.last->device_time_s) {
    const std::int64_t by = whole((*reading.device_time_s - *s.last->device_time_s) / s.clock.period_s());
    const std::int64_t k = s.last_k + by;
    return by == 0 || (by < 0 && by >= -kOvertaken && k >= s.first_k && s.find(k) == nullptr);
  }
  if (reading.y_nT != s.last->y_nT) return false;
  const double due = s.clock.index_of(sample_s) - static_cast<double>(s.last_k);
  return due < kNotYet;
}

/// By how much the number rises: as the device's clock or count says, as long as the sample does not then
/// arrive before it was taken. A count that jumps is uncertain (torn lines merge, garbage looks like lines);
/// where delivery is prompt, the time between decides, and is no proof either: the bytes of garbage take time
/// on the line, and a count and a delay that are both wrong may agree. 0: not even by one.
Sampler::Step Sampler::step(const Stream& s, const FieldReading& reading, double sample_s) const {
  const auto counted = static_cast<std::int64_t>(reading.seq - s.last->seq);
  std::int64_t timed = 0;
  if (reading.device_time_s && s.last->device_time_s) {
    timed = whole((*reading.device_time_s - *s.last->device_time_s) / s.clock.period_s());
  }
  const double due =
      s.clock.index_of(sample_s) - static_cast<double>(s.last_k);  // at most, delay being positive
  const double slack = s.clock.settled() ? kImpossiblyEarly : config_.silence_s / period_s_;
  const auto possible = [&](std::int64_t by) { return by > 0 && static_cast<double>(by) < due + slack; };
  if (timed > 0 && possible(timed)) return {timed, 0};
  const ClockState clock = s.clock.state();
  if (counted > 1 && clock.settled && clock.residual_s < kPrompt * period_s_) {
    const double prompt = due - clock.residual_s / period_s_;
    const std::int64_t by = std::clamp<std::int64_t>(whole(prompt), 1, counted + kMerged);
    return {by, by - 1};
  }
  if (possible(counted)) return {counted, counted - 1};
  return {possible(1) ? 1 : 0, 0};
}

/// A delay that is no longer the usual one of this stream's delivery.
double Sampler::late_from_s(const Stream& s) const {
  return std::clamp(kLateResiduals * s.clock.state().residual_s, kLate * period_s_, kLatest * period_s_);
}

/// Frames lost before the driver saw them leave no trace but time: from then on every sample is whole periods
/// late. What waited for a host that stood still comes as fast as the line carries it, each sample less late
/// than the one before: as long as that goes on, nothing is said to be lost.
void Sampler::watch_lateness(Stream& s, double arrival_s, double delay_s) {
  Lateness& late = s.late;
  if (delay_s < late_from_s(s)) {
    // All were delayed, none was lost.
    if (late.samples > 0) s.lessen_lateness(late.first_k, kNoDoubt_s);
    late.samples = 0;
    return;
  }
  if (late.samples == 0) late = {0, s.last_k, arrival_s, delay_s, 0};
  ++late.samples;
  if (s.clock.settled()) s.clock.distrust();
  s.ring[static_cast<std::size_t>(s.last_k) & (s.ring.size() - 1)].late_s = delay_s;
  if (delay_s < late.least_s - kDrains * period_s_) {
    late.least_s = delay_s;
    late.since_s = arrival_s;
  }
  late.span_s = arrival_s - late.since_s;
  if (!s.clock.settled() || late.samples < kLateSamples || late.span_s < config_.silence_s / 2) return;
  const std::int64_t lost = std::max<std::int64_t>(1, whole(late.least_s / period_s_));
  const double sample_s = s.clock.time_of(static_cast<double>(s.last_k)) + delay_s;
  s.renumber(late.first_k, lost);
  s.lessen_lateness(late.first_k + lost, static_cast<double>(lost) * period_s_);
  count_lost(s, lost);
  late = {};
  // What looks like a loss may be a rate that changed.
  s.clock.restart(s.last_k, sample_s);
}

/// Numbers are proved by prompt samples that nothing was waiting before, or by many that were neither early
/// nor late. One prompt sample is none: behind garbage lines come back to back, and one that carries a
/// supplement takes longer than a period. Late ones prove nothing: of a device that sends half as often as it
/// should, each is later than the one before.
void Sampler::watch_doubt(Stream& s, double since_last_s, double delay_s) const {
  if (s.doubtful == 0) return;
  const double usual_s = s.clock.state().residual_s;
  const bool due = delay_s > -kAgree * period_s_ && delay_s < usual_s + kAgree * period_s_;
  const bool prompt = due && since_last_s > kIdle * period_s_;
  const bool never_prompt = usual_s > kPrompt * period_s_;
  s.prompt = prompt ? s.prompt + 1 : 0;
  s.in_time = delay_s < late_from_s(s) ? s.in_time + 1 : 0;
  if ((s.last_k > s.doubtful_since && s.prompt >= kPromptInARow) || (never_prompt && s.in_time >= kProved)) {
    s.prove(s.doubtful_since);
    s.doubtful = 0;
  }
}

bool Sampler::in_doubt() const {
  return std::any_of(streams_.begin(), streams_.end(), [](const Stream& s) { return s.in_doubt(); });
}

double Sampler::grid_index(double t_s) const {
  const ClockModel& clock = streams_[kReference].clock;
  return clock.empty() ? grid_.k + (t_s - grid_.t_s) / grid_.period_s : clock.index_of(t_s);
}

double Sampler::grid_time(std::int64_t k) const {
  const ClockModel& clock = streams_[kReference].clock;
  const auto at = static_cast<double>(k);
  return clock.empty() ? grid_.t_s + (at - grid_.k) * grid_.period_s : clock.time_of(at);
}

void Sampler::advance(Instant now, std::vector<EpochOrGap>& out) {
  if (!begun_) return;
  now_s_ = std::max(now_s_, seconds(now));
  emit_ready(out);
  emit_silent_reference(out);
  if (open_gap_ && now_s_ - open_since_s_ > kHoldGap_s) flush_gap(out);
}

SamplerHealth Sampler::health() const {
  SamplerHealth health{epochs_, gaps_, PerSensor<SensorStreamHealth>(streams_.size())};
  for (std::size_t i = 0; i < streams_.size(); ++i) {
    health.sensors[i] = streams_[i].health;
    health.sensors[i].clock = streams_[i].clock.state();
  }
  return health;
}

}  // namespace mgtd::daemon::acquire
