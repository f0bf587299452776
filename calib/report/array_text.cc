// SPDX-License-Identifier: Apache-2.0
#include "calib/report/array_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace mgtd::calib::report {
namespace {

using calibration::FieldExpansion;

constexpr std::array<const char*, 3> kAxisNames{"x", "y", "z"};

/// "s1", "s1 and s2", "s1 to s5"
std::string all_sensors(const FieldExpansion& array) {
  if (array.sensors() == 1) return "s1";
  return fmt::format("s1 {} s{}", array.sensors() == 2 ? "and" : "to", array.sensors());
}

std::string listed(const std::vector<std::string>& words) {
  if (words.size() < 2) return fmt::format("{}", fmt::join(words, ""));
  return fmt::format("{} and {}", fmt::join(words.begin(), words.end() - 1, ", "), words.back());
}

/// Number of the axis that this direction is; -1 for an oblique one.
int axis_of(const Eigen::Vector3d& direction) {
  for (int axis = 0; axis < 3; ++axis) {
    if (direction == Eigen::Vector3d::Unit(axis)) return axis;
  }
  return -1;
}

std::string field_clause(const FieldExpansion& array) {
  if (array.field_at_origin()) return "field";
  const std::string where = point_text(array.field_place_P_m()) + " m";
  if (array.sensors() == 1) return fmt::format("field at s1, {},", where);
  if (array.shape().dimension() == 0) return fmt::format("field at the place of the sensors, {},", where);
  return fmt::format("field at the centroid of the sensors, {},", where);
}

/// Sensors on one line, or at one place.
void add_little(const FieldExpansion& array, std::vector<std::string>& out) {
  if (array.sensors() == 1) {
    out.push_back(field_clause(array) + " only: one sensor sees no gradient");
    return;
  }
  if (array.shape().dimension() == 0) {
    out.push_back(fmt::format("{} only: sensors at one place ({}) see no gradient", field_clause(array),
                              all_sensors(array)));
    return;
  }
  const Eigen::Vector3d& u = array.derivatives_along().front().direction_P;
  const int axis = axis_of(u);
  std::vector<std::string> known;
  for (std::size_t c = 0; c < array.determined().size(); ++c) {
    if (array.determined()[c]) known.emplace_back(calibration::kGradientNames[c]);
  }
  const std::string line =
      fmt::format("{} and the derivative along the line through {}", field_clause(array), all_sensors(array));
  if (axis >= 0) {
    out.push_back(fmt::format("{} ({} axis): {}", line, kAxisNames[static_cast<std::size_t>(axis)],
                              fmt::join(known, ", ")));
  } else {
    out.push_back(
        fmt::format("{} (direction {}): three combinations of the gradient's components, and no component by "
                    "itself",
                    line, point_text(u)));
  }
  out.emplace_back("the rest of the gradient cannot be told by sensors on one line");
}

/// What a flat array does not measure, and what is measured twice.
void add_all(const FieldExpansion& array, std::vector<std::string>& out) {
  out.push_back(field_clause(array) + " and all five independent components of the gradient");
  std::array<bool, 3> apart{};
  for (int axis = 0; axis < 3; ++axis)
    apart[static_cast<std::size_t>(axis)] = array.shape().spans(Eigen::Vector3d::Unit(axis));
  if (array.shape().dimension() == 2) {
    // Two axes within the plane make the third its normal.
    if (std::count(apart.begin(), apart.end(), true) == 2) {
      const char* n =
          kAxisNames[static_cast<std::size_t>(std::find(apart.begin(), apart.end(), false) - apart.begin())];
      out.push_back(
          fmt::format("the sensors do not stand apart in {}, so G{}{} is not measured and follows "
                      "from the vanishing divergence",
                      n, n, n));
    } else {
      out.emplace_back(
          "the sensors lie in one plane, so the derivative along its normal of the field along its normal is "
          "not measured and follows from the vanishing divergence");
    }
  }
  std::vector<std::string> twice;
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = a + 1; b < 3; ++b) {
      if (apart[a] && apart[b]) twice.push_back(fmt::format("G{}{}", kAxisNames[a], kAxisNames[b]));
    }
  }
  if (twice.size() == 1) out.push_back(twice.front() + " is measured twice and checks itself");
  if (twice.size() > 1) out.push_back(listed(twice) + " are measured twice and check themselves");
}

/// Without symmetry and trace the model would have 3 + 3 d unknowns in d directions: what they leave over
/// tells a change that is not linear. The conditions within these directions, d (d - 1) / 2 of symmetry and
/// in space that of the trace, are the rest.
std::string closure_clause(const FieldExpansion& array) {
  const Eigen::Index d = array.shape().dimension(), total = array.closure_dof();
  if (total == 0) return "0 closure numbers: nothing checks a sample";
  const Eigen::Index beyond = 3 * array.sensors() - 3 - 3 * d;
  std::vector<std::string> parts;
  if (d >= 2) parts.push_back(fmt::format("{} for a curl", d == 2 ? 1 : 3));
  if (d == 3) parts.emplace_back("1 for a divergence");
  if (beyond > 0) {
    parts.push_back(d == 0 ? fmt::format("{} for sensors that disagree", beyond)
                           : fmt::format("{} for a change that is not linear", beyond));
  }
  return fmt::format("{} closure number{} every sample ({})", total, total == 1 ? " checks" : "s check",
                     fmt::join(parts, ", "));
}

}  // namespace

std::string point_text(const Eigen::Vector3d& r, double step) {
  // Adding zero makes a negative zero positive.
  const auto rounded = [step](double x) { return std::round(x / step) * step + 0.0; };
  return fmt::format("({:g}, {:g}, {:g})", rounded(r.x()), rounded(r.y()), rounded(r.z()));
}

std::string what_it_tells(const FieldExpansion& array) {
  std::vector<std::string> clauses;
  if (array.shape().dimension() < 2) {
    add_little(array, clauses);
  } else {
    add_all(array, clauses);
  }
  if (array.shape().neglected_m > calibration::kOnePlace_m) {
    clauses.push_back(fmt::format("sensors stand up to {:.2g} mm off that line, which is neglected",
                                  1000 * array.shape().neglected_m));
  }
  clauses.push_back(closure_clause(array));
  return fmt::format("{}", fmt::join(clauses, "; "));
}

}  // namespace mgtd::calib::report
