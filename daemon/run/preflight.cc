// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/preflight.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "calib/calibration/tensor.h"
#include "daemon/run/angles_text.h"
#include "daemon/run/wiring.h"

namespace mgtd::daemon::run {
namespace {

constexpr std::size_t kMinPairs = 20;     // fewer make no standard deviation worth the name
constexpr double kFrozenPreflight = 0.5;  // of successive values, equal
constexpr double kTableSilence_s = 10.0;  // a table at rest is asked every second
constexpr double kReachTolerance_rad = 1e-3;
constexpr double kStandstill_s = 1.0;  // after a second without a byte a digitiser is taken for silent

std::string named(const char* what, int slot) { return fmt::format("{}.s{}", what, slot + 1); }

Check check(std::string name, bool passed, std::string measured, std::string limit, std::string remedy) {
  return {std::move(name), passed, std::move(measured), std::move(limit), passed ? "" : std::move(remedy)};
}

/// "azimuth 529.70 is outside 0 to 360 deg", or nothing.
std::string outside_limits(const TableAngles& a, const drivers::TableLimits& limits) {
  struct Axis {
    const char* name;
    double at_rad;
    const drivers::TableLimits::Range& range;
  };
  for (const Axis& axis : {Axis{"azimuth", a.azimuth_rad, limits.azimuth},
                           Axis{"pitch", a.pitch_rad, limits.pitch}, Axis{"roll", a.roll_rad, limits.roll}})
    if (axis.at_rad < axis.range.min_rad - kReachTolerance_rad ||
        axis.at_rad > axis.range.max_rad + kReachTolerance_rad)
      return fmt::format("{} {:.2f} is outside {:.6g} to {:.6g} deg", axis.name, to_deg(axis.at_rad),
                         to_deg(axis.range.min_rad), to_deg(axis.range.max_rad));
  return "";
}

}  // namespace

void Preflight::add(const EpochOrGap& item) {
  if (const auto* gap = std::get_if<Gap>(&item)) {
    if (gap->at.mono < begin_) return;
    if (!first_) first_ = gap->at.mono;
    missing_ += gap->to_seq - gap->from_seq + 1;
    why_missing_ = gap->why;
    return;
  }
  const Epoch& epoch = std::get<Epoch>(item);
  if (epoch.t.mono < begin_) return;
  if (!first_) first_ = epoch.t.mono;
  last_ = epoch.t.mono;
  y_nT_.push_back(calib::calibration::stacked(epoch.y_nT));
  seq_.push_back(epoch.seq);
  if (epoch.flags.has(Flag::saturated)) ++saturated_;
  skew_s_ = epoch.skew_bound_s;  // the clock models settle: the last one counts
}

void Preflight::add(const ScalarReading& reading) {
  if (reading.arrival.mono >= begin_) scalar_.push_back(reading);
}

void Preflight::add(const TableReading& reading) {
  table_ = reading;
  listened_to_the_table_ = Duration{0};
}

void Preflight::passes(Instant now) {
  if (last_event_) {
    const Duration between = now - *last_event_;
    longest_standstill_ = std::max(longest_standstill_, between);
    if (between < from_seconds(kStandstill_s)) listened_to_the_table_ += between;
  }
  last_event_ = now;
}

std::string Preflight::remedy(std::string otherwise) const {
  if (longest_standstill_ < from_seconds(kStandstill_s)) return otherwise;
  return fmt::format(
      "this computer is too busy: the daemon stood still for {:.1f} s meanwhile; end other programs (or let "
      "the simulation run less fast) and start again; if it fails as before: {}",
      to_seconds(longest_standstill_), otherwise);
}

bool Preflight::complete(Instant now) const {
  // By the time of the data: a program that slept still has to read what came meanwhile.
  const bool seen = first_ && last_ && *last_ - *first_ >= from_seconds(config_.length_s);
  const bool looked = seen || (first_ && now - *first_ >= from_seconds(config_.length_s + config_.wait_s));
  const bool heard = first_ && table_ && (!config_.scalar || !scalar_.empty());
  const bool waited = now - begin_ >= from_seconds(config_.wait_s);
  return heard ? looked : waited && (!first_ || looked);
}

Preflight::Statistics Preflight::statistics() const {
  Statistics s(Eigen::Index{3} * sensors_);
  if (y_nT_.empty()) return s;
  const auto n = static_cast<double>(y_nT_.size());
  for (const Sample& y : y_nT_) s.mean_nT += y / n;
  for (const Sample& y : y_nT_) s.scatter_nT += (y - s.mean_nT).cwiseAbs2() / std::max(1.0, n - 1);
  s.scatter_nT = s.scatter_nT.cwiseSqrt();
  for (std::size_t i = 1; i < y_nT_.size(); ++i) {
    if (seq_[i] != seq_[i - 1] + 1) continue;
    const Sample step = y_nT_[i] - y_nT_[i - 1];
    s.noise_nT += step.cwiseAbs2();
    s.changes += (step.array() != 0).cast<double>().matrix();
    ++s.pairs;
  }
  if (s.pairs > 0) s.noise_nT = (s.noise_nT / (2 * static_cast<double>(s.pairs))).cwiseSqrt();
  return s;
}

double Preflight::noise_nT() const {
  const Statistics s = statistics();
  return s.pairs >= kMinPairs ? s.noise_nT.maxCoeff() : 0.0;
}

std::vector<double> Preflight::good_field_nT() const {
  std::vector<double> f_nT;
  for (const ScalarReading& r : scalar_) {
    if (r.good) f_nT.push_back(r.f_nT);
  }
  return f_nT;
}

std::optional<double> Preflight::expected_field_nT() const {
  auto f_nT = good_field_nT();
  if (f_nT.empty()) return config_.field_nT;
  std::nth_element(f_nT.begin(), f_nT.begin() + static_cast<std::ptrdiff_t>(f_nT.size() / 2), f_nT.end());
  return f_nT[f_nT.size() / 2];
}

Check Preflight::rate() const {
  const double span_s = first_ && last_ ? to_seconds(*last_ - *first_) : 0;
  const auto epochs = static_cast<double>(y_nT_.size()) + static_cast<double>(missing_);
  const double rate_hz = span_s > 0 ? (epochs - 1) / span_s : 0;
  return check(
      "rate", std::abs(rate_hz / config_.rate_hz - 1) <= config_.max_rate_error,
      fmt::format("{:.2f} epochs/s", rate_hz),
      fmt::format("{:.2f} epochs/s within {:.0f} %", config_.rate_hz, 100 * config_.max_rate_error),
      remedy(y_nT_.empty()
                 ? "no epoch came: `mgt status` says which sensor is silent; check its port and supply"
                 : "set the digitisers and rate_hz of the configuration to the same rate"));
}

Check Preflight::gaps() const {
  const auto all = static_cast<double>(y_nT_.size()) + static_cast<double>(missing_);
  const double share = all > 0 ? static_cast<double>(missing_) / all : 1;
  const std::string why = why_missing_.empty() ? "" : ": " + why_missing_;
  return check("gaps", share <= config_.max_gap_share,
               fmt::format("{} of {:.0f} epochs not measured{}", missing_, all, why),
               fmt::format("{:.0f} %", 100 * config_.max_gap_share),
               remedy("check cable, port and baud rate of the sensor named"));
}

Check Preflight::saturation() const {
  return check("saturation", saturated_ == 0,
               fmt::format("{} of {} epochs saturated", saturated_, y_nT_.size()), "none",
               "choose the sensor's larger range, or look for iron near the array");
}

/// The limit is a sample's period beside what ordinary delivery may hide of two clocks that were never seen
/// to beat with their timers: the step of 16 ms and the host's scheduling.
Check Preflight::skew() const {
  return check(
      "clock", !y_nT_.empty() && skew_s_ <= config_.max_skew_s,
      y_nT_.empty() ? "no epoch" : fmt::format("{:.2f} ms between the sensors at most", 1e3 * skew_s_),
      fmt::format("{:.0f} ms", 1e3 * config_.max_skew_s),
      remedy("a port delivers late: lower its latency timer and give it as delivery_s, or use another USB "
             "hub"));
}

Check Preflight::wiring(const Statistics& s) const {
  Wiring seen;
  PerSensor<Eigen::Vector3d> y_nT(static_cast<std::size_t>(sensors_));
  for (int slot = 0; slot < sensors_; ++slot)
    y_nT.at(static_cast<std::size_t>(slot)) = s.mean_nT.segment<3>(Eigen::Index{3} * slot);
  seen.add(y_nT, std::nullopt);
  const std::vector<std::string> findings = seen.findings();
  return check("wiring", true,
               findings.empty() ? alike_in_words(y_nT.size()) : fmt::format("{}", fmt::join(findings, "; ")),
               "none; the first turns of the table tell more", "");
}

Check Preflight::noise(int slot, const Statistics& s) const {
  const Eigen::Vector3d sd_nT = s.noise_nT.segment<3>(Eigen::Index{3} * slot);
  const bool known = s.pairs >= kMinPairs;
  return check(named("noise", slot), known && sd_nT.maxCoeff() <= config_.max_noise_nT,
               known ? fmt::format("{:.2f} {:.2f} {:.2f} nT", sd_nT.x(), sd_nT.y(), sd_nT.z())
                     : fmt::format("{} pairs of successive epochs", s.pairs),
               fmt::format("{:.0f} nT per axis", config_.max_noise_nT),
               "look for mains hum, a loose connector, or a powered motor near this sensor");
}

Check Preflight::scatter(int slot, const Statistics& s) const {
  int worst = 3 * slot;
  double most = 0;
  for (int axis = 3 * slot; axis < 3 * slot + 3; ++axis) {
    const double excess = s.scatter_nT[axis] / std::max(s.noise_nT[axis], 1e-9);
    if (s.scatter_nT[axis] <= config_.scatter_floor_nT || excess <= most) continue;
    most = excess;
    worst = axis;
  }
  return check(named("rest", slot), most <= config_.max_scatter_ratio,
               most > 0 ? fmt::format("{} scatters by {:.2f} nT, {:.1f} x its noise",
                                      calib::sensor::channel_name(worst), s.scatter_nT[worst], most)
                        : fmt::format("below {:.0f} nT", config_.scatter_floor_nT),
               fmt::format("{:.0f} x the noise", config_.max_scatter_ratio),
               "the field moves: keep people, cars and tools away, see that the table stands still");
}

Check Preflight::alive(int slot, const Statistics& s) const {
  int worst = 3 * slot;
  for (int axis = 3 * slot; axis < 3 * slot + 3; ++axis) {
    if (s.changes[axis] < s.changes[worst]) worst = axis;
  }
  const auto pairs = static_cast<double>(s.pairs);
  const bool moves = !config_.frozen_check || s.changes[worst] > kFrozenPreflight * pairs;
  return check(named("alive", slot), s.pairs > 0 && moves,
               fmt::format("{} changed in {:.0f} of {:.0f} steps", calib::sensor::channel_name(worst),
                           s.changes[worst], pairs),
               fmt::format("{:.0f} %", 100 * kFrozenPreflight),
               "the digitiser repeats an old sample or the channel is open: check supply and cable");
}

Check Preflight::field(int slot, const Statistics& s) const {
  const double y_nT = s.mean_nT.segment<3>(Eigen::Index{3} * slot).norm();
  const auto f_nT = expected_field_nT();
  const double low_nT = f_nT ? *f_nT * (1 - config_.max_field_error) : kEarthFieldMin_nT;
  const double high_nT = f_nT ? *f_nT * (1 + config_.max_field_error) : kEarthFieldMax_nT;
  return check(named("field", slot), y_nT >= low_nT && y_nT <= high_nT, fmt::format("{:.0f} nT", y_nT),
               fmt::format("{:.0f} to {:.0f} nT{}", low_nT, high_nT, f_nT ? " (reference)" : ""),
               "check the sensor's range and nT per volt in the configuration, its cable, and iron nearby");
}

Check Preflight::scalar() const {
  const auto f_nT = good_field_nT();
  const auto n = static_cast<double>(f_nT.size());
  double mean_nT = 0, square = 0;
  for (const double f : f_nT) mean_nT += f / n;
  for (const double f : f_nT) square += (f - mean_nT) * (f - mean_nT);
  const double sd_nT = n > 1 ? std::sqrt(square / (n - 1)) : 0;
  const bool plausible = mean_nT >= kEarthFieldMin_nT && mean_nT <= kEarthFieldMax_nT;
  const bool mostly_good = !f_nT.empty() && 2 * f_nT.size() >= scalar_.size();
  return check("scalar", mostly_good && plausible && sd_nT <= config_.max_scalar_sd_nT,
               fmt::format("{} of {} readings good, {:.2f} nT, sd {:.2f} nT", f_nT.size(), scalar_.size(),
                           mean_nT, sd_nT),
               fmt::format("half of them good, {:.0f} to {:.0f} nT, sd {:.0f} nT", kEarthFieldMin_nT,
                           kEarthFieldMax_nT, config_.max_scalar_sd_nT),
               "tune the magnetometer to the local field, turn its sensor, move it away from iron; or run "
               "without it and state field_nT");
}

Check Preflight::table(const drivers::TableLimits& limits) const {
  constexpr const char* kRemedy = "check the controller's power, port and axis names; is the axis free?";
  if (!table_ || listened_to_the_table_ > from_seconds(kTableSilence_s))
    return check("table", false, "no position from the table",
                 fmt::format("one every {:.0f} s", kTableSilence_s), remedy(kRemedy));
  const TableAngles& a = table_->angles;
  const std::string outside = table_->referenced ? outside_limits(a, limits) : "";
  return check(
      "table", outside.empty() && !table_->moving,
      fmt::format("{}, {}, {}", angles_text(a), table_->referenced ? "referenced" : "not referenced yet",
                  table_->moving ? "moving" : "at rest"),
      "at rest within its limits",
      outside.empty() ? kRemedy
                      : outside +
                            ": see that no cable is wound up, then switch the controller off "
                            "and on: the run begins with a reference move");
}

std::vector<Check> Preflight::checks(const drivers::TableLimits& limits) const {
  const Statistics s = statistics();
  std::vector<Check> all;
  for (const auto& [device, health] : links_) {
    all.push_back(check("link." + device, health.state == LinkState::live,
                        fmt::format("{} {}", kLinkStateNames.at(static_cast<std::size_t>(health.state)),
                                    health.identity.empty() ? health.detail : health.identity),
                        "live",
                        remedy(health.detail.empty() ? "check port, cable and power" : health.detail)));
  }
  all.insert(all.end(), {rate(), gaps(), saturation(), skew()});
  for (int slot = 0; slot < sensors_; ++slot)
    all.insert(all.end(), {alive(slot, s), noise(slot, s), scatter(slot, s), field(slot, s)});
  all.push_back(wiring(s));
  if (config_.scalar) all.push_back(scalar());
  all.push_back(table(limits));
  return all;
}

bool all_passed(const std::vector<Check>& checks) {
  return std::all_of(checks.begin(), checks.end(), [](const Check& c) { return c.passed; });
}

}  // namespace mgtd::daemon::run
