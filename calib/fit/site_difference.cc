// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/site_difference.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "calib/stats/median.h"
#include "calib/stats/probability.h"

namespace mgtd::calib::fit {
namespace {

constexpr double kGross_sd = 5;  ///< from the median

struct Difference {
  double nT, stated_nT2;
};

std::vector<Difference> differences(const PoseTable& table) {
  std::vector<Difference> out;
  for (const Pose& pose : table.poses)
    if (pose.f_nT && pose.ref_nT && pose.angles())
      out.push_back({*pose.f_nT - pose.ref_nT->norm(),
                     std::pow(reference_sd_nT(pose), 2) + std::pow(scalar_sd_nT(pose), 2)});
  return out;
}

/// Leaves out those further from the median than `kGross_sd` of its robust standard deviation and of the
/// stated one.
void leave_out_gross(std::vector<Difference>& all) {
  std::vector<double> values, off;
  for (const Difference& d : all) values.push_back(d.nT);
  const double middle = stats::median(values);
  for (const double x : values) off.push_back(std::abs(x - middle));
  const double spread = stats::kMadToSd * stats::median(off);
  std::erase_if(all, [&](const Difference& d) {
    return std::abs(d.nT - middle) > kGross_sd * std::max(spread, std::sqrt(d.stated_nT2));
  });
}

}  // namespace

double reference_sd_nT(const Pose& pose) { return pose.ref_sd_nT.value_or(kDefaultScalarSd_nT); }

double scalar_sd_nT(const Pose& pose) { return pose.f_sd_nT.value_or(kDefaultScalarSd_nT); }

SiteDifference site_difference(const PoseTable& table) {
  std::vector<Difference> kept = differences(table);
  leave_out_gross(kept);
  SiteDifference out;
  out.poses = static_cast<int>(kept.size());
  if (out.poses == 0) return out;
  double sum = 0, squares = 0, stated = 0;
  for (const Difference& d : kept) sum += d.nT, stated += d.stated_nT2;
  out.mean_nT = sum / out.poses;
  for (const Difference& d : kept) squares += std::pow(d.nT - out.mean_nT, 2);
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
