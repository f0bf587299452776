// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "calib/calibration/calibration.h"
#include "calib/fit/fit_options.h"
#include "calib/fit/joint/joint_problem.h"
#include "calib/fit/joint/joint_start.h"
#include "calib/fit/readings.h"
#include "proto/units.h"

/// joint_problem() makes the joint problem from a pose table: it decides which poses take part, what each
/// observation weighs and which gauge holds.
namespace mgtd::calib::fit::joint {

struct JointOptions {
  sensor::Geometry geometry;
  std::vector<effects::EffectPtr> effects;
  std::optional<double> field_nT;  ///< known field where no scalar reference is in the data
  /// Of field_nT; without it the field is taken as exact within kCommonFieldSpread_nT.
  std::optional<double> field_sd_nT;
  std::optional<double> inclination_rad, declination_rad;  ///< of the site's field at zero table angles
  double table_sd_rad{to_rad(0.1)};                        ///< start value, estimated
  /// Variance of a pose mean beside that of the dwells, by channel, or empty for none: for an axis that
  /// follows a law which the model lacks, so that its misfit does not bend the parameters of other axes.
  Channels more_nT2;
  /// Factor on the stated noise of readings and scalar reference, for a model that is known to be far off:
  /// its misfit would otherwise bend the parameters that are weakly determined.
  double noise_inflation{1};
  double most_left_out{FitOptions().most_left_out};
  std::stop_token stop{};    ///< of FitOptions
  RoundListener on_round{};  ///< of FitOptions
};

/// Spread of the true field from pose to pose that is allowed for when no scalar reference follows it.
inline constexpr double kCommonFieldSpread_nT = 0.05;
/// Noise of a pose mean until something better is known.
inline constexpr double kStartNoise_nT = 1.0;

/// Poses of set "check" are left out. Refuses too few poses; a vector reference in only a part of them, or a
/// scalar one where no vector fills the others in (site_difference.h); with a vector reference, table angles
/// in only a part of them; a vector reference beside the table that is too weak for its noise to have a
/// direction; and effects whose needs the poses do not meet. Keeps pointers into `table`.
[[nodiscard]] Result<JointProblem> joint_problem(const PoseTable& table, const JointOptions& options,
                                                 PoseUse use = PoseUse::fit);

/// What holds the freedoms that the data leave.
struct Gauge {
  AngleCoverage angles{AngleCoverage::none};
  bool declination_known{false};
  bool by_reference{false};  ///< the frame is that of a vector reference
  bool beside_table{false};  ///< a vector reference stands still beside the table
  /// Of its turn about the field; empty where the field kept its direction and nothing tells it.
  std::optional<double> reference_turn_sd_rad{};
  bool scale_known{false};
  bool turns_held{false};  ///< s1 is taken not to turn with its temperature (common_turn.h)
  int constraints{0};      ///< freedoms fixed by convention
};
/// Adds the constraints to `problem`.
Gauge fix_gauge(JointProblem& problem, const JointOptions& options);

/// Noise of one sample per axis, pooled over the dwells; empty unless every axis has a spread and every pose
/// a count.
[[nodiscard]] std::optional<calibration::AxisNoise> sample_noise(const PoseTable& table);
/// Sets the reading weights: `sample` noise by each pose's effective count, or `pose_mean` noise for all
/// alike. Keeps zero weights.
void weight_by_samples(JointProblem& problem, const calibration::AxisNoise& sample);
void weight_by_pose(JointProblem& problem, const calibration::AxisNoise& pose_mean);
/// Adds a variance to that of every reading, by channel; and what effects that remember add to it.
void add_variance(JointProblem& problem, const Channels& nT2);
void add_memory_variance(JointProblem& problem, double factor);

/// Field to start from: mean scalar reference, or the given field, or the mean size of the readings'
/// variation.
[[nodiscard]] double start_field_nT(const JointProblem& problem, const JointOptions& options);

}  // namespace mgtd::calib::fit::joint
