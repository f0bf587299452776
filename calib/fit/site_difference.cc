// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/site_difference.h"

#include <algorithm>
#include <cmath>

namespace mgtd::calib::fit {
namespace {

double scalar_sd_nT(const Pose& pose) { return pose.f_sd_nT.value_or(kDefaultScalarSd_nT); }

}  // namespace

double reference_sd_nT(const Pose& pose) { return pose.ref_sd_nT.value_or(kDefaultScalarSd_nT); }

SiteDifference site_difference(const PoseTable& table) {
  SiteDifference out;
  double sum = 0, squares = 0, stated = 0;
  const auto each = [&](auto&& visit) {
    for (const Pose& pose : table.poses)
      if (pose.f_nT && pose.ref_nT && pose.angles()) visit(pose, *pose.f_nT - pose.ref_nT->norm());
  };
  each([&](const Pose& pose, double difference) {
    ++out.poses;
    sum += difference;
    stated += std::pow(reference_sd_nT(pose), 2) + std::pow(scalar_sd_nT(pose), 2);
  });
  if (out.poses == 0) return out;
  out.mean_nT = sum / out.poses;
  each([&](const Pose&, double difference) { squares += std::pow(difference - out.mean_nT, 2); });
  if (out.poses > 1) out.scatter_nT = std::sqrt(squares / (out.poses - 1));
  out.sd_nT = std::max(out.scatter_nT, std::sqrt(stated / out.poses)) / std::sqrt(out.poses);
  return out;
}

TotalField total_field(const Pose& pose, const SiteDifference& difference) {
  if (pose.f_nT) return {*pose.f_nT, scalar_sd_nT(pose)};
  const double size_nT = pose.ref_nT->norm(), sd_nT = reference_sd_nT(pose);
  if (!pose.angles()) return {size_nT, sd_nT};
  return {size_nT + difference.mean_nT, std::max(sd_nT, difference.scatter_nT)};
}

}  // namespace mgtd::calib::fit
