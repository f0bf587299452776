// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/field_blocks.h"

#include "calib/calibration/tensor.h"

namespace mgtd::daemon::run {

FieldBlocks::FieldBlocks(double rate_hz, Instant begin, std::size_t sensors)
    : expected_samples_(rate_hz * kBlock_s),
      begin_(begin),
      block_end_(begin + from_seconds(kBlock_s)),
      sum_nT_(Axes::Zero(3 * static_cast<Eigen::Index>(sensors))),
      offset_nT_(sum_nT_),
      steps_nT2_(sum_nT_) {}

void FieldBlocks::add(const EpochOrGap& item) {
  const auto* const epoch = std::get_if<Epoch>(&item);
  const Instant at = epoch != nullptr ? epoch->t.mono : std::get<Gap>(item).at.mono;
  if (at < begin_) return;
  for (; at >= block_end_; block_end_ += from_seconds(kBlock_s)) close_block();
  if (epoch == nullptr) return;
  const Axes y_nT = calib::calibration::stacked(epoch->y_nT);
  if (!last_) offset_nT_ = y_nT;
  if (last_ && epoch->seq == last_seq_ + 1) {
    steps_nT2_ += (y_nT - *last_).cwiseAbs2();
    ++steps_;
  }
  last_ = y_nT;
  last_seq_ = epoch->seq;
  sum_nT_ += y_nT - offset_nT_;
  ++in_block_;
}

void FieldBlocks::add(const ScalarReading& reading) {
  if (reading.good && reading.arrival.mono >= begin_) f_nT_.push_back(reading.f_nT);
}

void FieldBlocks::close_block() {
  if (2 * static_cast<double>(in_block_) > expected_samples_)
    means_nT_.push_back(sum_nT_ / static_cast<double>(in_block_));
  sum_nT_.setZero();
  in_block_ = 0;
}

FieldBlocks::Axes FieldBlocks::scatter_nT2() const {
  Axes mean = Axes::Zero(sum_nT_.size()), out = mean;
  for (const Axes& block : means_nT_) mean += block / static_cast<double>(means_nT_.size());
  for (const Axes& block : means_nT_) out += (block - mean).cwiseAbs2();
  return out;
}

FieldBlocks::Axes FieldBlocks::expected_nT2() const {
  if (steps_ == 0) return Axes::Zero(sum_nT_.size());
  return steps_nT2_ / (2 * static_cast<double>(steps_) * expected_samples_);
}

}  // namespace mgtd::daemon::run
