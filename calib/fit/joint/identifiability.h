// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "calib/fit/joint/joint_problem.h"

/// Identifiability says which combinations of parameters the poses do not determine.
///
/// The information matrix is put into nanotesla at the mean field (offsets as they are, scale factors and
/// angles times F), the common rotation is taken out (it turns the platform frame and leaves the tensor of a
/// uniform field alone), and the eigenvectors with the least information are described.
namespace mgtd::calib::fit::joint {

struct WeakDirection {
  double sd_nT{0};  ///< of the corrected field along it; infinite when nothing is known
  /// Those that make up most of it, largest part first: "s1 offset z", "scale z of all sensors".
  std::vector<std::string> parameters;
  bool others{false};         ///< further parameters have a part in it that counts
  Eigen::VectorXd direction;  ///< unit vector in the fixed block, nT units
};

/// Where the field of the site went in the platform frame: a ring about an axis.
struct FieldCoverage {
  Eigen::Vector3d axis_P{Eigen::Vector3d::UnitZ()};
  double least_rad{0}, most_rad{0};  ///< angles between the field and that axis
};

/// Above this a direction is worth naming: 1e-3 of 50 000 nT, which is 125 nT/m across a 0.4 m cross.
inline constexpr double kWeak_nT = 50;
/// Above this the calibration has no meaning: half a percent of the field, more than a fluxgate as bought.
inline constexpr double kUnusable = 0.005;

struct Identifiability {
  std::vector<WeakDirection> weak;  ///< weakest first, those above kWeak_nT
  double condition{1};              ///< of what the rig's parameters do to the field; infinite when singular
  FieldCoverage coverage;
  std::vector<TableAngles> add;  ///< poses that would help most, best first; empty when nothing is weak
  [[nodiscard]] double worst_nT() const { return weak.empty() ? 0 : weak.front().sd_nT; }
};

/// Attitudes over the whole sphere that a two- or three-axis table can take, none twice.
[[nodiscard]] const std::vector<TableAngles>& candidate_attitudes();

/// `candidates` are the attitudes that may be proposed.
[[nodiscard]] Identifiability identifiability(
    const JointProblem& problem, const JointState& state, const Eigen::MatrixXd& S, double f_nT,
    const std::vector<TableAngles>& candidates = candidate_attitudes());

/// Information about the fixed block that one more pose at these table angles would bring, with the noise,
/// the scalar reference and the table of the problem's first pose.
[[nodiscard]] Eigen::MatrixXd information_of(const JointProblem& problem, const JointState& state,
                                             const TableAngles& angles, double f_nT);

}  // namespace mgtd::calib::fit::joint
