// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/dwell.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calib/calibration/tensor.h"
#include "calib/poses/pose_columns.h"
#include "daemon/run/run_clock.h"

namespace mgtd::daemon::run {
namespace {

constexpr double kCorrelationNoise = 1.5;   // standard deviations of a correlation that is none
constexpr double kFrozenDwell = 0.5;        // of successive samples, all three axes exactly equal
constexpr double kScalarPriorReadings = 4;  // weight of the configured scatter of one scalar reading

}  // namespace

Dwell::Dwell(DwellConfig config, Instant begin, std::size_t sensors)
    : config_(config),
      begin_(begin),
      end_(begin + from_seconds(config.length_s)),
      T_degC_(sensors),
      repeats_(sensors) {}

void Dwell::add(const EpochOrGap& item) {
  if (const auto* gap = std::get_if<Gap>(&item)) {
    past_end_ = past_end_ || gap->at.mono >= end_;
    return;
  }
  const Epoch& epoch = std::get<Epoch>(item);
  past_end_ = past_end_ || epoch.t.mono >= end_;
  if (!inside(epoch.t.mono)) return;
  const Sample y = calib::calibration::stacked(epoch.y_nT);
  for (std::size_t i = 0; i < repeats_.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(3 * i);
    if (last_nT_ && y.segment<3>(at) == last_nT_->segment<3>(at)) ++repeats_[i];
    if (std::isfinite(epoch.T_degC[i])) {
      T_degC_[i].sum += epoch.T_degC[i];
      ++T_degC_[i].count;
    }
  }
  last_nT_ = y;
  ++heard_;
  if (epoch.flags.has(Flag::saturated)) ++saturated_;
  if (config_.frozen_check && epoch.flags.has(Flag::frozen)) {
    ++frozen_;
    return;
  }
  y_nT_.push_back(y);
  seq_.push_back(epoch.seq);
}

void Dwell::add(const ScalarReading& reading) {
  if (reading.good && inside(reading.arrival.mono)) f_nT_.push_back(reading.f_nT);
}

void Dwell::add(const AuxiliaryReading& reading) {
  if (!inside(reading.arrival.mono)) return;
  for (const auto& [column, value] : reading.values) {
    Sum& sum = auxiliary_[column];
    sum.sum += value;
    ++sum.count;
  }
}

bool Dwell::complete(Instant now) const { return past_end_ || now >= end_ + from_seconds(config_.grace_s); }

DwellQuality Dwell::quality() const {
  DwellQuality q;
  q.epochs = y_nT_.size();
  const double expected = std::floor(config_.length_s * config_.rate_hz * (1 - 1e-9));
  q.missing =
      q.epochs >= static_cast<std::size_t>(expected) ? 0 : static_cast<std::size_t>(expected) - q.epochs;
  q.gap_share = expected > 0 ? static_cast<double>(q.missing) / expected : 0;
  q.frozen = frozen_;
  q.saturated = saturated_;
  q.repeats = repeats_;
  return q;
}

Result<void> Dwell::acceptable() const {
  const DwellQuality q = quality();
  const bool thin = q.gap_share > config_.max_gap_share || q.epochs < kFewestInDwell;
  const double allowed = thin && q.frozen > 0 ? 0 : kFrozenDwell * static_cast<double>(heard_ - 1);
  const auto most = std::max_element(q.repeats.begin(), q.repeats.end());
  if (config_.frozen_check && static_cast<double>(*most) > allowed) {
    return fail(ErrorCode::refused,
                fmt::format("s{} gave exactly the same three values in {} of {} successive samples",
                            most - q.repeats.begin() + 1, *most, heard_ - 1),
                "the digitiser repeats an old sample: power-cycle it and check the sensor's supply");
  }
  if (q.gap_share > config_.max_gap_share) {
    return fail(ErrorCode::refused,
                fmt::format("{} of {} epochs of the dwell are missing ({:.0f} %, limit {:.0f} %)", q.missing,
                            q.missing + q.epochs, 100 * q.gap_share, 100 * config_.max_gap_share),
                "see which sensor the GAP records name, and the state of its port");
  }
  if (thin) {
    return fail(ErrorCode::refused,
                fmt::format("{} epochs in the dwell of {:g} s, at least {} are needed", q.epochs,
                            config_.length_s, kFewestInDwell),
                "see which sensor the GAP records name, or lengthen the dwells");
  }
  if (static_cast<double>(q.saturated) > config_.max_saturated_share * static_cast<double>(heard_)) {
    return fail(ErrorCode::refused, fmt::format("{} of {} epochs are saturated", q.saturated, heard_),
                "choose the sensor's larger range, or look for iron near the array");
  }
  return {};
}

/// 1 + 2 sum of the autocorrelations, pooled over a sensor's axes: the variance of the mean is that many
/// times sd^2 / n. The sum ends where the correlation is lost in its own noise.
double Dwell::correlation_time(int slot, const std::vector<Sample>& residual) const {
  const auto n = static_cast<double>(residual.size());
  const auto sum = [&](std::size_t lag) {
    double products = 0, pairs = 0;
    for (std::size_t i = lag; i < residual.size(); ++i) {
      if (seq_[i] != seq_[i - lag] + lag) continue;
      products += residual[i].segment<3>(3 * slot).dot(residual[i - lag].segment<3>(3 * slot));
      ++pairs;
    }
    return pairs > 0 ? products / pairs : 0.0;
  };
  const double variance = sum(0);
  double time = 1;
  for (std::size_t lag = 1; variance > 0 && lag < residual.size() / 4; ++lag) {
    const double r = sum(lag) / variance + 1 / n;  // about the sample's own mean it comes out low by 1/n
    if (r < kCorrelationNoise / std::sqrt(3 * n)) break;
    time += 2 * r;
  }
  return time;
}

/// Mean and scatter of each axis. The least correlated sensor decides n_eff, the others' sd are raised to
/// match, so that sd^2 / n_eff is the variance of every mean and sd that of a sample before interpolation
/// smoothed it.
void Dwell::fill_readings(Pose& pose) const {
  const auto n = static_cast<double>(y_nT_.size());
  const Eigen::Index axes = y_nT_.front().size();
  Sample mean = Sample::Zero(axes), square = Sample::Zero(axes);
  for (const Sample& y : y_nT_) mean += y - y_nT_.front();
  mean = mean / n + y_nT_.front();
  std::vector<Sample> residual;
  residual.reserve(y_nT_.size());
  for (const Sample& y : y_nT_) {
    residual.push_back(y - mean);
    square += residual.back().cwiseAbs2();
  }
  PerSensor<double> time(repeats_.size());
  for (std::size_t slot = 0; slot < time.size(); ++slot)
    time[slot] = correlation_time(static_cast<int>(slot), residual);
  const double least = *std::min_element(time.begin(), time.end());
  for (Eigen::Index axis = 0; axis < axes; ++axis) {
    const auto slot = static_cast<std::size_t>(axis / 3), component = static_cast<std::size_t>(axis % 3);
    pose.y_nT[slot][axis % 3] = mean[axis];
    pose.sd_nT[slot][component] = std::sqrt(square[axis] / (n - 1) * time[slot] / least);
  }
  pose.n = n;
  pose.n_eff = std::max(1.0, n / least);
}

/// Scatter of few readings is little known: it is pooled with the configured one.
void Dwell::fill_scalar(Pose& pose) const {
  if (f_nT_.empty()) return;
  const auto n = static_cast<double>(f_nT_.size());
  double mean = 0;
  for (const double f : f_nT_) mean += f - f_nT_.front();
  mean = mean / n + f_nT_.front();
  double square = kScalarPriorReadings * config_.scalar_sd_nT * config_.scalar_sd_nT;
  for (const double f : f_nT_) square += (f - mean) * (f - mean);
  pose.f_nT = mean;
  pose.f_sd_nT = std::sqrt(square / (n - 1 + kScalarPriorReadings) / n);
}

Result<Pose> Dwell::pose(const DwellPlace& place) const {
  if (auto ok = acceptable(); !ok) return tl::unexpected(ok.error());
  Pose pose = calib::poses::unmeasured_pose(repeats_.size());
  pose.number = place.number;
  pose.set = place.set;
  if (place.angles) {
    pose.azimuth_rad = place.angles->azimuth_rad;
    pose.pitch_rad = place.angles->pitch_rad;
    pose.roll_rad = place.angles->roll_rad;
  }
  const Instant middle = begin_ + (end_ - begin_) / 2;
  pose.t_s = to_seconds(middle - place.run_start.mono);
  pose.t_utc = wall_in_run(place.run_start, middle);
  if (place.stopped) pose.since_stop_s = to_seconds(middle - *place.stopped);
  pose.dwell_s = config_.length_s;
  pose.mount = place.mount;
  pose.sense = place.sense;
  fill_readings(pose);
  fill_scalar(pose);
  for (std::size_t i = 0; i < T_degC_.size(); ++i) {
    if (T_degC_[i].count > 0) pose.T_degC[i] = T_degC_[i].sum / static_cast<double>(T_degC_[i].count);
  }
  for (const auto& [column, sum] : auxiliary_)
    pose.covariates[column] = sum.sum / static_cast<double>(sum.count);
  return pose;
}

}  // namespace mgtd::daemon::run
