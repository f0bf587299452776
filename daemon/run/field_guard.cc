// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/field_guard.h"

#include <cmath>
#include <numeric>

namespace mgtd::daemon::run {

FieldGuard::FieldGuard(const FieldGuardConfig& config, Instant now)
    : config_(config), blocks_(config.rate_hz, now, config.sensors), noise_(config.scalar_sd_nT) {}

void FieldGuard::watch(Instant from) {
  blocks_ = FieldBlocks(config_.rate_hz, from, config_.sensors);
  judged_ = 0;
  change_.reset();
}

std::optional<FieldDisturbance> FieldGuard::disturbed(double length_s) {
  if (blocks_.blocks() == judged_) return std::nullopt;
  judged_ = blocks_.blocks();
  change_ = change_in(blocks_, noise_, config_.limits);
  return disturbance_in(blocks_, noise_, config_.limits,
                        static_cast<std::size_t>(std::ceil(length_s / FieldBlocks::kBlock_s)));
}

std::optional<FieldDisturbance> FieldGuard::at_another_level(std::optional<double> f_nT) const {
  if (!level_nT_ || !f_nT || config_.step_nT <= 0 || std::abs(*f_nT - *level_nT_) <= config_.step_nT)
    return std::nullopt;
  return FieldDisturbance{.change_nT = *f_nT - *level_nT_,
                          .limit_nT = config_.step_nT,
                          .seen_by = FieldDisturbance::SeenBy::level,
                          .level_nT = *f_nT};
}

void FieldGuard::given_up(Instant now) {
  watch(now);
  if (!since_) since_ = now;
}

double FieldGuard::waited_s(Instant now) const { return since_ ? to_seconds(now - *since_) : 0; }

FieldGuard::Calm FieldGuard::calm() {
  if (disturbed(config_.calm_s)) return Calm::disturbed;
  if (static_cast<double>(blocks_.blocks()) * FieldBlocks::kBlock_s < config_.calm_s) return Calm::not_yet;
  return at_another_level(mean_nT()) ? Calm::disturbed : Calm::yes;
}

std::optional<double> FieldGuard::mean_nT() const {
  const std::vector<double>& f_nT = blocks_.scalar_nT();
  if (f_nT.empty()) return std::nullopt;
  return std::accumulate(f_nT.begin(), f_nT.end(), 0.0) / static_cast<double>(f_nT.size());
}

void FieldGuard::stored(std::optional<double> f_nT) {
  level_nT_ = f_nT;
  since_.reset();
}

void FieldGuard::paused() {
  level_nT_.reset();
  since_.reset();
}

}  // namespace mgtd::daemon::run
