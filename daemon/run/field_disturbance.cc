// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/field_disturbance.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "calib/stats/f_distribution.h"

namespace mgtd::daemon::run {
namespace {

constexpr double kMemory = 400;              // degrees of freedom
constexpr double kScalarPrior = 4;           // readings' worth of the configured scatter
constexpr double kSmallestNoise_nT2 = 1e-8;  // of a block: below any instrument's resolution
constexpr std::size_t kScalarReadings = 3;   // fewer make no scatter

/// Of the quotient S / (A (B - 1)): counted as if all sensors saw the same.
double dof_of(std::size_t blocks) { return 3 * (static_cast<double>(blocks) - 1); }

double square_sum(const std::vector<double>& f_nT) {
  double mean = 0, sum = 0;
  for (const double f : f_nT) mean += (f - f_nT.front()) / static_cast<double>(f_nT.size());
  for (const double f : f_nT) sum += (f - f_nT.front() - mean) * (f - f_nT.front() - mean);
  return sum;
}

/// Of the axes of all sensors, per sensor: change of the vector.
double per_sensor(const FieldBlocks::Axes& nT2) { return 3 * nT2.mean(); }

}  // namespace

FieldNoise::FieldNoise(double scalar_sd_nT)
    : scalar_sum_nT2_(kScalarPrior * scalar_sd_nT * scalar_sd_nT), scalar_dof_(kScalarPrior) {}

void FieldNoise::begin(const FieldBlocks& at_rest) {
  sum_ = dof_ = 0;
  if (at_rest.blocks() < 2) return;
  weight_nT2_ = at_rest.expected_nT2().cwiseMax(kSmallestNoise_nT2);
  add(at_rest);
}

void FieldNoise::add(const FieldBlocks& at_rest) {
  if (at_rest.blocks() < 2) return;
  if (weight_nT2_.size() == 0) weight_nT2_.setOnes(at_rest.scatter_nT2().size());
  sum_ += at_rest.scatter_nT2().cwiseQuotient(weight_nT2_).mean() * 3;
  dof_ += dof_of(at_rest.blocks());
  if (const auto n = static_cast<double>(at_rest.scalar_nT().size()); n >= 2) {
    scalar_sum_nT2_ += square_sum(at_rest.scalar_nT());
    scalar_dof_ += n - 1;
  }
  const double keep = std::min(1.0, kMemory / dof_), keep_scalar = std::min(1.0, kMemory / scalar_dof_);
  sum_ *= keep;
  dof_ *= keep;
  scalar_sum_nT2_ *= keep_scalar;
  scalar_dof_ *= keep_scalar;
}

double FieldNoise::block_nT() const { return known() ? std::sqrt(sum_ / dof_ * per_sensor(weight_nT2_)) : 0; }

std::string_view name(FieldDisturbance::SeenBy seen_by) {
  static constexpr std::array<std::string_view, 3> kNames{"array", "scalar", "level"};
  return kNames.at(static_cast<std::size_t>(seen_by));
}

std::string FieldDisturbance::in_words() const {
  if (seen_by == SeenBy::level)
    return fmt::format(
        "the scalar reference reads {:.1f} nT, {:+.1f} nT against the pose before (limit {:.1f} nT)",
        level_nT, change_nT, limit_nT);
  return fmt::format("the field changed by {:.2g} nT{} while the table stood (limit {:.2g} nT)", change_nT,
                     seen_by == SeenBy::scalar ? " at the scalar reference" : "", limit_nT);
}

/// Reads the noise.
struct DisturbanceStatistic {
  const FieldBlocks& field;
  const FieldNoise& noise;

  struct Look {
    double change_nT, f, k, nu;  ///< F with its degrees of freedom
    FieldDisturbance::SeenBy seen_by;
  };

  [[nodiscard]] std::optional<Look> array() const {
    if (field.blocks() < 2 || !noise.known()) return std::nullopt;
    const double n = static_cast<double>(field.blocks()) - 1;
    const FieldBlocks::Axes scatter_nT2 = field.scatter_nT2();
    const double f = scatter_nT2.cwiseQuotient(noise.weight_nT2_).mean() / n / (noise.sum_ / noise.dof_);
    const double noise_nT = noise.block_nT();
    const double change_nT = std::sqrt(std::max(0.0, per_sensor(scatter_nT2) / n - noise_nT * noise_nT));
    return Look{change_nT, f, dof_of(field.blocks()), noise.dof_, FieldDisturbance::SeenBy::array};
  }
  [[nodiscard]] std::optional<Look> scalar() const {
    if (field.scalar_nT().size() < kScalarReadings) return std::nullopt;
    const double n = static_cast<double>(field.scalar_nT().size()) - 1;
    const double square_nT2 = square_sum(field.scalar_nT()) / n,
                 at_rest_nT2 = noise.scalar_sum_nT2_ / noise.scalar_dof_;
    return Look{std::sqrt(std::max(0.0, square_nT2 - at_rest_nT2)), square_nT2 / at_rest_nT2, n,
                noise.scalar_dof_, FieldDisturbance::SeenBy::scalar};
  }
};

std::optional<FieldChange> change_in(const FieldBlocks& field, const FieldNoise& noise,
                                     const DisturbanceLimits& limits) {
  const DisturbanceStatistic statistic{field, noise};
  const auto array = statistic.array();
  if (!array) return std::nullopt;
  const auto scalar = statistic.scalar();
  return FieldChange{std::max(array->change_nT, scalar ? scalar->change_nT : 0), limits.limit_nT};
}

std::optional<FieldDisturbance> disturbance_in(const FieldBlocks& field, const FieldNoise& noise,
                                               const DisturbanceLimits& limits, std::size_t looks) {
  const double log10_p =  // of one look at one of the two
      std::log10(limits.false_alarm / (2 * static_cast<double>(std::max<std::size_t>(looks, 1))));
  const DisturbanceStatistic statistic{field, noise};
  for (const auto& look : {statistic.array(), statistic.scalar()}) {
    if (look && look->change_nT > limits.limit_nT &&
        calib::stats::f_log10_p(look->f, look->k, look->nu) <= log10_p)
      return FieldDisturbance{
          .change_nT = look->change_nT, .limit_nT = limits.limit_nT, .seen_by = look->seen_by};
  }
  return std::nullopt;
}

}  // namespace mgtd::daemon::run
