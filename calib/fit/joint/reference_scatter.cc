// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/reference_scatter.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <set>

#include "calib/fit/joint/joint_fit.h"
#include "calib/fit/site_difference.h"

namespace mgtd::calib::fit::joint {
namespace {

constexpr int kFewestDifferences = 20;
constexpr double kMuchOff = 2, kSigmas = 5;

/// Squares of differences from the reference, and the part of them that something else explains.
struct Differences {
  double squares{0}, others{0};
  int count{0};
};

/// Of the scalar magnetometer, about their mean.
Differences from_scalar(const PoseTable& table) {
  Differences out;
  const SiteDifference difference = site_difference(table);
  double others = 0, both = 0;
  for (const Pose& pose : table.poses)
    if (pose.f_nT && pose.ref_nT && pose.angles()) others += std::pow(scalar_sd_nT(pose), 2), ++both;
  if (!difference.known()) return out;
  out.count = difference.poses;
  out.squares = std::pow(difference.scatter_nT, 2) * (out.count - 1);
  out.others = others / both * out.count;
  return out;
}

/// Of what the sensors say of the field, each pose by its own readings; poses of which something was left out
/// do not count.
Differences from_sensors(const JointFit& fit) {
  Differences out;
  std::set<std::size_t> left_out;
  for (const OutlierNode& node : fit.outliers) left_out.insert(node.place);
  JointProblem alone = fit.problem;
  for (JointPose& pose : alone.poses) pose.reference_weight = pose.f_weight = 0;
  const PoseModel model(alone, fit.state);
  PoseBlocks b;
  for (std::size_t k = 0; k < alone.poses.size(); ++k) {
    if (left_out.contains(k)) continue;
    const JointPose& pose = alone.poses[k];
    assemble(alone, model, fit.state, k, Blocks::own, b);
    const Eigen::LLT<Eigen::Matrix4d> H(b.H);
    if (H.info() != Eigen::Success) continue;
    const Eigen::Matrix4d variance = H.solve(Eigen::Matrix4d::Identity());
    const Nuisance x = fit.state.nuisances[k] + variance * b.g;
    if (pose.has_angles) {
      out.squares += std::pow(pose.reference_nT.norm() - x[3], 2);
      out.others += variance(3, 3);
      ++out.count;
    } else {
      out.squares += (pose.reference_nT - x.head<3>()).squaredNorm();
      out.others += variance.diagonal().head<3>().sum();
      out.count += 3;
    }
  }
  return out;
}

/// What the fit of one sensor takes: the map of three components, or that of the size.
constexpr double kFitted = 12, kFittedToSize = 9;

}  // namespace

std::optional<ReferenceScatter> reference_scatter(const PoseTable& table, const JointFit& fit) {
  if (!fit.problem.has_reference) return std::nullopt;
  ReferenceScatter out;
  Differences d = from_scalar(table);
  double fitted = 1;
  out.by_scalar = d.count >= kFewestDifferences;
  if (!out.by_scalar) {
    // Sizes of which some were filled in by a scalar magnetometer are no longer those of the vector.
    if (d.count > 0 || !fit.sample_noise_nT || fit.noise_inflation > 1) return std::nullopt;
    d = from_sensors(fit);
    fitted = fit.problem.has_angles ? kFittedToSize : kFitted;
  }
  const double freedom = d.count - fitted;
  if (freedom < kFewestDifferences - 1) return std::nullopt;
  const double whole = d.squares / freedom, variance = whole - d.others / d.count;
  double stated = 0;
  for (const JointPose& pose : fit.problem.poses) {
    stated += std::pow(reference_sd_nT(*pose.pose), 2);
    out.stated = out.stated && pose.pose->ref_sd_nT;
  }
  stated /= static_cast<double>(fit.problem.poses.size());
  out.measured_nT = std::sqrt(std::max(0.0, variance));
  out.stated_nT = std::sqrt(stated);
  const double larger = std::max(out.measured_nT, out.stated_nT),
               smaller = std::min(out.measured_nT, out.stated_nT);
  // If what is stated were right, the squares would scatter by that.
  const double chance = std::sqrt(2 / freedom) * std::max(whole, stated + d.others / d.count);
  out.differs = larger > kMuchOff * smaller && std::abs(variance - stated) > kSigmas * chance;
  return out;
}

}  // namespace mgtd::calib::fit::joint
