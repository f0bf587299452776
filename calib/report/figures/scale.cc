// SPDX-License-Identifier: Apache-2.0
#include "calib/report/figures/scale.h"

#include <algorithm>
#include <cmath>

namespace mgtd::calib::report::figures {
namespace {

bool usable(double value, ScaleKind kind) {
  return std::isfinite(value) && (kind == ScaleKind::linear || value > 0);
}

double laid_out(double value, ScaleKind kind) { return kind == ScaleKind::log ? std::log10(value) : value; }

/// A range that a scale can divide by.
Range widened(Range range, ScaleKind kind) {
  if (!usable(range.from, kind) || !usable(range.to, kind))
    return kind == ScaleKind::log ? Range{1, 10} : Range{0, 1};
  if (range.to < range.from) std::swap(range.from, range.to);
  if (kind == ScaleKind::log)
    return range.to > range.from * 1.001 ? range : Range{range.from / 3, range.to * 3};
  const double size = std::max(std::abs(range.from), std::abs(range.to));
  if (range.to - range.from > 1e-12 * size) return range;
  const double half = size > 0 ? 0.1 * size : 1;
  return {range.from - half, range.to + half};
}

}  // namespace

Scale::Scale(Range range, double at_from, double at_to, ScaleKind kind)
    : range_(widened(range, kind)), kind_(kind), at_from_(at_from) {
  per_unit_ = (at_to - at_from) / (laid_out(range_.to, kind) - laid_out(range_.from, kind));
}

double Scale::operator()(double value) const {
  return at_from_ + per_unit_ * (laid_out(value, kind_) - laid_out(range_.from, kind_));
}

bool Scale::holds(double value) const {
  if (!usable(value, kind_)) return false;
  const double span = laid_out(range_.to, kind_) - laid_out(range_.from, kind_);
  const double at = (laid_out(value, kind_) - laid_out(range_.from, kind_)) / span;
  constexpr double kRounding = 1e-9;
  return at >= -kRounding && at <= 1 + kRounding;
}

Range range_of(std::span<const double> values, ScaleKind kind, double margin) {
  bool any = false;
  Range out;
  for (const double v : values) {
    if (!usable(v, kind)) continue;
    out = any ? Range{std::min(out.from, v), std::max(out.to, v)} : Range{v, v};
    any = true;
  }
  if (!any) return kind == ScaleKind::log ? Range{1, 10} : Range{0, 1};
  out = widened(out, kind);
  if (kind == ScaleKind::log) {
    const double more = std::pow(out.to / out.from, margin);
    return {out.from / more, out.to * more};
  }
  const double more = margin * (out.to - out.from);
  return {out.from - more, out.to + more};
}

bool spread_out(std::span<const double> values) {
  const auto first = std::find_if(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
  return std::any_of(first, values.end(), [&](double v) { return std::isfinite(v) && v != *first; });
}

Range joined(const Range& a, const Range& b) { return {std::min(a.from, b.from), std::max(a.to, b.to)}; }

Range symmetric_range_of(std::span<const double> values, double margin) {
  double most = 0;
  for (const double v : values)
    if (std::isfinite(v)) most = std::max(most, std::abs(v));
  if (most == 0) most = 1;
  return {-most * (1 + margin), most * (1 + margin)};
}

}  // namespace mgtd::calib::report::figures
