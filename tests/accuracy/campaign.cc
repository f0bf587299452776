// SPDX-License-Identifier: Apache-2.0
#include "tests/accuracy/campaign.h"

#include <Eigen/Cholesky>
#include <random>
#include <stdexcept>

#include "calib/effects/library/library.h"
#include "calib/fit/joint/joint_fit.h"
#include "calib/fit/joint/tensor_uncertainty.h"
#include "calib/fit/two_step/two_step.h"
#include "calib/stats/chi_square.h"
#include "proto/units.h"

namespace mgtd::testing {
namespace {

using calib::fit::joint::FixedSlots;
using calib::sensor::kSensorParameters;
using calib::sensor::SensorModel;

constexpr std::array<double, 5> kGradient{30, -45, -20, 50, 10};  // nT/m; norm of the tensor 50 and more
constexpr double kNormal95 = 1.959964;
constexpr std::size_t kStandardPoses = 36;

calib::fit::joint::JointOptions options_of(const Scene& scene) {
  calib::fit::joint::JointOptions out;
  if (scene.gradient) out.effects = {*calib::effects::library::make_effect("site.gradient")};
  return out;
}

calib::fit::joint::JointFit fitted(const PoseTable& table, const Scene& scene) {
  auto fit = calib::fit::joint::fit_joint(table, options_of(scene));
  if (!fit) throw std::runtime_error(fit.error().text());
  return *std::move(fit);
}

/// Fields of one strength uniformly over the sphere, the same for all runs.
std::vector<Eigen::Vector3d> clean_fields(double f_nT) {
  constexpr int kCount = 300;
  std::mt19937_64 random(4242);
  std::normal_distribution<double> normal;
  std::vector<Eigen::Vector3d> out;
  for (int k = 0; k < kCount; ++k) {
    const double z = normal(random), y = normal(random), x = normal(random);
    out.push_back(f_nT * Eigen::Vector3d(x, y, z).normalized());
  }
  return out;
}

/// Eq. 3 of fields that should be equal at the four sensors.
Components tensor_of(const std::array<Eigen::Vector3d, 4>& b, double d_m) {
  const Eigen::Vector3d by_x = (b[0] - b[2]) / d_m, by_y = (b[1] - b[3]) / d_m;
  return {by_x[0], by_y[1], -by_x[0] - by_y[1], (by_x[1] + by_y[0]) / 2, by_x[2], by_y[2]};
}

Components mean_square(const PerSensor<SensorModel>& estimate, const Scene& scene,
                       const std::vector<Eigen::Vector3d>& fields) {
  Components sum = Components::Zero();
  for (const Eigen::Vector3d& b : fields) {
    std::array<Eigen::Vector3d, 4> corrected;
    for (std::size_t i = 0; i < corrected.size(); ++i) {
      const auto y = reading(scene.rig[i], {b[0], b[1], b[2]});
      corrected[i] = estimate[i].correct({y[0], y[1], y[2]});
    }
    sum += tensor_of(corrected, scene.site.baseline_m).square() / static_cast<double>(fields.size());
  }
  return sum;
}

/// Inverse of the information at the truth with the true weights.
Components bound_square(const PoseTable& table, const Scene& scene) {
  calib::fit::joint::JointOptions options = options_of(scene);
  options.table_sd_rad = to_rad(scene.table_sd_deg);
  auto problem = calib::fit::joint::joint_problem(table, options);
  if (!problem) throw std::runtime_error(problem.error().text());
  calib::fit::joint::fix_gauge(*problem, options);
  calib::fit::joint::weight_by_pose(*problem,
                                    calib::calibration::AxisNoise::Constant(kSensors, 3, scene.noise_nT));
  const auto n =
      calib::fit::joint::direction_of(to_rad(scene.site.inclination_deg), to_rad(scene.site.declination_deg));
  const auto truth = models_of(scene.rig);
  const calib::fit::joint::JointState state =
      calib::fit::joint::joint_state(*problem, truth, n, scene.site.f_nT);
  const auto covariance = calib::fit::joint::covariance_of(calib::fit::joint::reduce(*problem, state, 0).S);
  if (!covariance) throw std::runtime_error(covariance.error().text());
  const Gradient g = calib::fit::joint::calibration_tensor_sd(
      truth, calib::sensor::Geometry(scene.site.baseline_m), *covariance, scene.site.f_nT);
  return Components(g.xx, g.yy, g.zz, g.xy, g.xz, g.yz).square();
}

/// Estimate less truth: the 48 parameters, then the coefficients of the gradient.
Eigen::VectorXd error_of(const calib::fit::joint::JointFit& fit, const Scene& scene) {
  const auto truth = models_of(scene.rig);
  const Eigen::Index m = fit.state.coefficients.size();
  Eigen::VectorXd e(FixedSlots{}.sensor_block() + m);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    e.segment<kSensorParameters>(static_cast<Eigen::Index>(i) * kSensorParameters) =
        fit.state.sensors[i].parameters() - truth[i].parameters();
  }
  for (Eigen::Index j = 0; j < m; ++j)
    e[FixedSlots{}.sensor_block() + j] =
        fit.state.coefficients[j] - kGradient.at(static_cast<std::size_t>(j));
  return e;
}

Eigen::MatrixXd covariance_of_errors(const calib::fit::joint::JointFit& fit) {
  std::vector<Eigen::Index> slots;
  for (Eigen::Index slot = 0; slot < fit.covariance.rows(); ++slot) {
    if (slot < FixedSlots{}.sensor_block() || slot >= calib::fit::joint::FixedSlots{}.effects())
      slots.push_back(slot);
  }
  return fit.covariance(slots, slots);
}

std::string name_of(Eigen::Index j) {
  if (j >= FixedSlots{}.sensor_block()) return "site.gradient";
  return "s" + std::to_string(j / kSensorParameters + 1) + " " +
         std::string(calib::sensor::kParameterNames.at(static_cast<std::size_t>(j % kSensorParameters)));
}

}  // namespace

PoseTable Scene::run(std::uint64_t seed) const {
  Site there = site;
  if (gradient) there.gradient_nT_per_m = kGradient;
  PoseTable table = measure(rig, there, standard_run(poses - kStandardPoses, 2 * seed + 1), kStandardPoses,
                            {Noise::Kind::gaussian, noise_nT, table_sd_deg, f_sd_nT}, 2 * seed);
  for (Pose& pose : table.poses) {
    if (!spreads) pose.sd_nT = {};
  }
  return table;
}

Components tensor_mean_square(const PerSensor<SensorModel>& estimate, const Scene& scene) {
  return mean_square(estimate, scene, clean_fields(scene.site.f_nT));
}

TensorErrors tensor_errors(const Scene& scene, int seeds) {
  constexpr int kBoundEvery = 10;
  const auto fields = clean_fields(scene.site.f_nT);
  TensorErrors out;
  out.seeds = seeds;
  int bounds = 0;
  for (int seed = 0; seed < seeds; ++seed) {
    const PoseTable table = scene.run(1000 + static_cast<std::uint64_t>(seed));
    out.joint += mean_square(fitted(table, scene).state.sensors, scene, fields) / seeds;
    const auto readings = calib::fit::readings_of(table, {});
    const auto linear = calib::fit::two_step::two_step(*readings, {});
    if (!linear) throw std::runtime_error(linear.error().text());
    out.two_step += mean_square(linear->sensors, scene, fields) / seeds;
    if (seed % kBoundEvery != 0) continue;
    out.bound += bound_square(table, scene);
    ++bounds;
  }
  out.joint = out.joint.sqrt();
  out.two_step = out.two_step.sqrt();
  out.bound = (out.bound / bounds).sqrt();
  return out;
}

Consistency consistency(const Scene& scene, int runs) {
  Consistency out;
  out.runs = runs;
  Eigen::VectorXd covered;
  for (int run = 0; run < runs; ++run) {
    const calib::fit::joint::JointFit fit =
        fitted(scene.run(50'000 + static_cast<std::uint64_t>(run)), scene);
    const Eigen::VectorXd e = error_of(fit, scene);
    const Eigen::MatrixXd C = covariance_of_errors(fit);
    out.nees += e.dot(C.ldlt().solve(e)) / runs;
    if (run == 0) covered = Eigen::VectorXd::Zero(e.size());
    covered.array() += (e.array().abs() < kNormal95 * C.diagonal().array().sqrt()).cast<double>() / runs;
  }
  out.unknowns = static_cast<double>(covered.size());
  const double dof = out.unknowns * runs;
  out.band_low = calib::stats::chi_square_limit(0.9995, dof) / runs;
  out.band_high = calib::stats::chi_square_limit(0.0005, dof) / runs;
  out.intervals = static_cast<int>(covered.size()) * runs;
  out.covered = covered.mean();
  Eigen::Index worst = 0;
  (covered.array() - 0.95).abs().maxCoeff(&worst);
  out.worst_covered = covered[worst];
  out.worst = name_of(worst);
  return out;
}

PerSensor<SensorModel> models_of(const RigTruth& rig) {
  PerSensor<SensorModel> out;
  for (std::size_t i = 0; i < rig.size(); ++i) {
    calib::sensor::ParameterVector p;
    for (int j = 0; j < kSensorParameters; ++j) {
      const double value = rig[i].at(static_cast<std::size_t>(j));
      const bool angle = j <= calib::sensor::psi || j >= calib::sensor::alpha;
      p[j] = angle ? to_rad(value) : value;
    }
    out[i] = SensorModel::from_parameters(p);
  }
  return out;
}

}  // namespace mgtd::testing
