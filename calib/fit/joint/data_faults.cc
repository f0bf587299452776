// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/data_faults.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "calib/poses/field_unit.h"
#include "calib/stats/median.h"
#include "proto/units.h"

namespace mgtd::calib::fit::joint {
namespace {

/// No known field: readings of this size, in nT, are taken for uT. The field of the Earth is 22 to 67 uT.
constexpr double kFewest_nT = 10, kMost_nT = 200;
constexpr double kNearlyAll = 0.9;  ///< of the poses
/// A scale factor off by half turns a direction by 15 degrees at the most.
const double kTurnedApart_rad = to_rad(30);

/// "s2", "s1, s2 and s4", "all sensors".
std::string sensors_text(const std::vector<std::size_t>& which, std::size_t of) {
  if (which.size() == of && of > 1) return "all sensors";
  std::vector<std::string> names;
  for (const std::size_t i : which) names.push_back(fmt::format("s{}", i + 1));
  if (names.size() == 1) return names.front();
  const std::string last = names.back();
  names.pop_back();
  return fmt::format("{} and {}", fmt::join(names, ", "), last);
}

/// Median length of a sensor's readings; 0 where they hardly move: a dead sensor has no unit.
double size_of(const JointProblem& problem, std::size_t sensor) {
  constexpr double kMoves = 0.05;
  const auto reading = [sensor](const JointPose& pose) -> Eigen::Vector3d {
    return pose.y_nT.segment<3>(3 * static_cast<Eigen::Index>(sensor));
  };
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const JointPose& pose : problem.poses) mean += reading(pose);
  mean /= static_cast<double>(problem.poses.size());
  std::vector<double> sizes, ways;
  for (const JointPose& pose : problem.poses) {
    sizes.push_back(reading(pose).norm());
    ways.push_back((reading(pose) - mean).norm());
  }
  const double size = stats::median(std::move(sizes));
  return stats::median(std::move(ways)) > kMoves * size ? size : 0;
}

double field_of(const JointProblem& problem, double f_nT) {
  if (problem.common_field) return f_nT;
  std::vector<double> fields;
  for (const JointPose& pose : problem.poses) fields.push_back(pose.f_nT);
  return stats::median(std::move(fields));
}

/// The total field is the length of a vector reference.
bool field_by_vector(const JointProblem& problem) {
  return problem.has_reference &&
         std::none_of(problem.poses.begin(), problem.poses.end(),
                      [](const JointPose& pose) { return pose.pose->f_nT.has_value(); });
}

tl::unexpected<Error> wrong_unit(const std::vector<std::size_t>& which, std::size_t of, double size_nT,
                                 const poses::FieldUnit& unit) {
  return fail(ErrorCode::bad_input,
              fmt::format("the readings of {} look like {}: {:.4g} in the middle pose, in columns of nT",
                          sensors_text(which, of), unit.name, size_nT),
              fmt::format("multiply these columns (and their _sd_nT) by {}", unit.factor));
}

}  // namespace

Result<void> check_units(const JointProblem& problem, double f_nT) {
  const double field = field_of(problem, f_nT);
  PerSensor<double> size(problem.geometry.sensors());
  for (std::size_t i = 0; i < size.size(); ++i) size[i] = size_of(problem, i);
  std::vector<std::size_t> all(size.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const auto [least, most] = std::minmax_element(size.begin(), size.end());
  // The total field alone is off: it is the reference that has another unit.
  const bool earthly = *least > 1e4 && *most < 1e5;
  if (const auto unit = poses::field_unit_of(field / *most); earthly && unit)
    return fail(
        ErrorCode::bad_input,
        fmt::format("the {} looks like {}: {:.4g} where the readings are {:.4g} nT",
                    field_by_vector(problem) ? "vector reference" : "total field", unit->name, field, *most),
        fmt::format("multiply {} by {}",
                    field_by_vector(problem) ? "ref_x_nT, ref_y_nT and ref_z_nT (and ref_sd_nT)"
                                             : "f_nT (and f_sd_nT), or what you give with --field,",
                    unit->factor));
  std::vector<std::size_t> off;
  std::optional<poses::FieldUnit> unit;
  for (const std::size_t i : all) {
    const auto own = poses::field_unit_of(size[i] / field);
    if (!own || (unit && own->name != unit->name)) continue;
    unit = own;
    off.push_back(i);
  }
  if (unit) return wrong_unit(off, all.size(), size[off.front()], *unit);
  if (problem.common_field && *least > kFewest_nT && *most < kMost_nT)
    return wrong_unit(all, all.size(), *most, {"uT", "1000"});
  return {};
}

Result<void> check_copies(const JointProblem& problem) {
  const std::size_t sensors = problem.geometry.sensors();
  for (std::size_t first = 0; first < sensors; ++first) {
    std::vector<std::size_t> copies;
    for (std::size_t i = first + 1; i < sensors; ++i) {
      const auto same = std::count_if(problem.poses.begin(), problem.poses.end(), [&](const JointPose& p) {
        return p.y_nT.segment<3>(3 * static_cast<Eigen::Index>(i)) ==
               p.y_nT.segment<3>(3 * static_cast<Eigen::Index>(first));
      });
      if (static_cast<double>(same) > kNearlyAll * static_cast<double>(problem.poses.size()))
        copies.push_back(i);
    }
    if (copies.empty()) continue;
    return fail(
        ErrorCode::bad_input,
        fmt::format("{} {} digit for digit what s{} reads: one sensor was copied, {} are needed",
                    sensors_text(copies, sensors), copies.size() == 1 ? "reads" : "read", first + 1, sensors),
        "look at what fills the columns of these sensors: a port or a column was taken twice");
  }
  return {};
}

Result<void> check_turned_together(const PerSensor<Eigen::Matrix3Xd>& b_nT,
                                   const PerSensor<Eigen::Matrix3d>& to_first) {
  const Eigen::Matrix3Xd reference = b_nT[0].colwise().normalized();
  std::vector<std::size_t> apart;
  double worst_rad = 0;
  for (std::size_t i = 1; i < b_nT.size(); ++i) {
    const Eigen::Matrix3Xd own = to_first[i] * b_nT[i].colwise().normalized();
    std::vector<double> angles;
    for (Eigen::Index k = 0; k < own.cols(); ++k)
      angles.push_back(std::acos(std::clamp(own.col(k).dot(reference.col(k)), -1.0, 1.0)));
    const double middle = stats::median(std::move(angles));
    if (middle > kTurnedApart_rad) apart.push_back(i);
    worst_rad = std::max(worst_rad, middle);
  }
  if (apart.empty()) return {};
  return fail(
      ErrorCode::bad_input,
      fmt::format("{} did not turn together with s1: in the middle pose no fixed mounting brings the "
                  "directions in which they saw the field closer than {:.0f} deg (limit {:.0f})",
                  sensors_text(apart, b_nT.size()), to_deg(worst_rad), to_deg(kTurnedApart_rad)),
      "all readings of a pose belong to one attitude of one platform: look whether rows or columns of "
      "the table were mixed up, or whether the sensors were turned one by one");
}

}  // namespace mgtd::calib::fit::joint
