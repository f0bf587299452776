// SPDX-License-Identifier: Apache-2.0
#include "daemon/serve/console/lane_history.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace mgtd::daemon::serve::console {
namespace {

constexpr std::size_t kMostGaps = 300;
constexpr std::array<const char*, 6> kGradient{"xx", "yy", "zz", "xy", "xz", "yz"};
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double utc_s(WallTime t) { return 1e-9 * static_cast<double>(t.ns); }

/// What one column has seen.
struct Column {
  double sum{0}, count{0};
  double least{std::numeric_limits<double>::infinity()}, greatest{-std::numeric_limits<double>::infinity()};
};

}  // namespace

std::size_t LaneHistory::channel(std::string_view name) {
  const auto at = static_cast<std::size_t>(std::find(names_.begin(), names_.end(), name) - names_.begin());
  if (at == names_.size()) names_.emplace_back(name);
  return at;
}

void LaneHistory::put(Level& level, double t_s, const std::vector<std::pair<std::size_t, double>>& values) {
  const auto number = static_cast<std::int64_t>(std::floor(t_s / level.bin_s));
  if (!level.bins.empty() && number < level.bins.back().number) level.bins.clear();  // the clock was set back
  if (level.bins.empty() || level.bins.back().number != number) {
    if (level.bins.size() == level.most) level.bins.pop_front();
    level.bins.push_back({number, {}});
  }
  Bin& bin = level.bins.back();
  if (bin.sums.size() < names_.size()) bin.sums.resize(names_.size());
  for (const auto& [at, value] : values) {
    Sum& sum = bin.sums[at];
    if (sum.count == 0) sum = {.sum = 0, .least = 0, .greatest = 0, .first = value, .count = 0};
    const double off = value - sum.first;
    sum.sum += off;
    sum.least = std::min(sum.least, static_cast<float>(off));
    sum.greatest = std::max(sum.greatest, static_cast<float>(off));
    ++sum.count;
  }
}

void LaneHistory::add(const TensorSample& sample, const PerSensor<double>& T_degC,
                      std::span<const InputValue> inputs) {
  values_.clear();
  const auto take = [this](std::string_view name, double value) {
    if (std::isfinite(value)) values_.emplace_back(channel(name), value);
  };
  const auto g = components(sample.g_nT_per_m);
  for (std::size_t i = 0; i < kGradient.size(); ++i) take(kGradient[i], g[i]);
  take("bx", sample.b_P_nT.x());
  take("by", sample.b_P_nT.y());
  take("bz", sample.b_P_nT.z());
  take("f", sample.f_nT);
  take("chi2", sample.closure.chi2);
  std::array<char, 8> name{};
  for (std::size_t i = 0; i < T_degC.size(); ++i) {
    const auto end = fmt::format_to_n(name.data(), name.size(), "T{}", i + 1).size;
    take({name.data(), end}, T_degC[i]);
  }
  for (const InputValue& input : inputs) take(input.column, input.value);
  const double t_s = utc_s(sample.t.wall);
  for (Level& level : levels_) put(level, t_s, values_);
  if (in_gap_) gaps_.back().to_s = t_s;
  in_gap_ = false;
  last_s_ = t_s;
}

void LaneHistory::add(const Gap& gap) {
  const double at_s = utc_s(gap.at.wall);
  if (in_gap_ && gaps_.back().why == gap.why) {
    gaps_.back().to_s = std::max(gaps_.back().to_s, at_s);
    return;
  }
  if (gaps_.size() == kMostGaps) gaps_.pop_front();
  gaps_.push_back({last_s_ > 0 ? last_s_ : at_s, at_s, gap.why});
  in_gap_ = true;
}

std::vector<std::string> LaneHistory::channels() const { return names_; }

std::optional<Lane> LaneHistory::lane(std::string_view name, double window_s, std::size_t columns) const {
  const auto found = std::find(names_.begin(), names_.end(), name);
  if (found == names_.end() || columns == 0) return std::nullopt;
  const auto at = static_cast<std::size_t>(found - names_.begin());
  const auto reaches = [&](const Level& l) { return l.bin_s * static_cast<double>(l.most) >= window_s; };
  const auto fits = std::find_if(levels_.begin(), levels_.end(), reaches);
  const Level& level = fits == levels_.end() ? levels_.back() : *fits;
  // Columns begin at multiples of their width, or the line would wiggle as time goes on.
  const double bins = std::max(1.0, std::ceil(window_s / level.bin_s / static_cast<double>(columns)));
  const auto per_column = static_cast<std::int64_t>(bins);
  const std::int64_t last =
      level.bins.empty()
          ? 0
          : static_cast<std::int64_t>(std::floor(static_cast<double>(level.bins.back().number) / bins));
  const auto count = static_cast<std::int64_t>(std::ceil(window_s / level.bin_s / bins));
  const std::int64_t first = last - count + 1;
  std::vector<Column> filled(static_cast<std::size_t>(count));
  for (const Bin& bin : level.bins) {
    const auto column = static_cast<std::int64_t>(std::floor(static_cast<double>(bin.number) / bins)) - first;
    if (column < 0 || at >= bin.sums.size() || bin.sums[at].count == 0) continue;
    const Sum& sum = bin.sums[at];
    Column& c = filled[static_cast<std::size_t>(column)];
    c.sum += sum.sum + sum.first * sum.count;
    c.count += sum.count;
    c.least = std::min(c.least, sum.first + static_cast<double>(sum.least));
    c.greatest = std::max(c.greatest, sum.first + static_cast<double>(sum.greatest));
  }
  Lane out{.from_s = static_cast<double>(first * per_column) * level.bin_s,
           .step_s = bins * level.bin_s,
           .mean = {},
           .least = {},
           .greatest = {}};
  for (const Column& c : filled) {
    out.mean.push_back(c.count > 0 ? c.sum / c.count : kNaN);
    out.least.push_back(c.count > 0 ? c.least : kNaN);
    out.greatest.push_back(c.count > 0 ? c.greatest : kNaN);
  }
  return out;
}

std::vector<LaneGap> LaneHistory::gaps(double window_s) const {
  std::vector<LaneGap> out;
  for (const LaneGap& gap : gaps_)
    if (gap.to_s >= last_s_ - window_s) out.push_back(gap);
  return out;
}

}  // namespace mgtd::daemon::serve::console
