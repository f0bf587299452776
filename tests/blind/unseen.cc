// SPDX-License-Identifier: Apache-2.0
#include "tests/blind/unseen.h"

#include <stdexcept>

#include "calib/criticism/search/improve.h"
#include "calib/effects/library/library.h"
#include "calib/fit/joint/joint_errors.h"
#include "calib/fit/joint/joint_fit.h"
#include "calib/fit/joint/profile_search.h"
#include "tests/blind/blind.h"
#include "tests/rig/simulated_table.h"
#include "tests/support/checkout.h"
#include "tests/support/child_process.h"
#include "tests/support/whole_file.h"

namespace mgtd::calib::testing {
namespace {

template <class T>
T must(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().text());
  return *std::move(result);
}

fit::joint::JointOptions with(const std::vector<std::string>& effects) {
  fit::joint::JointOptions out;
  for (const std::string& spec : effects) out.effects.push_back(must(effects::library::make_effect(spec)));
  return out;
}

/// Of the poses of set "check", which this fit has not seen.
double check_rms_nT(const PoseTable& table, const fit::joint::JointOptions& options,
                    const fit::joint::JointFit& fit) {
  fit::joint::JointProblem problem = must(fit::joint::joint_problem(table, options, fit::PoseUse::check));
  for (fit::joint::JointPose& pose : problem.poses) {
    pose.weight = fit.pose_noise_nT.reshaped<Eigen::RowMajor>().cwiseInverse();
    if (pose.has_angles) pose.weigh_attitude(fit.table_sd_rad);
  }
  fit::joint::JointState state = fit::joint::joint_state(problem, fit.state);
  state.coefficients = fit.state.coefficients;
  fit::joint::refit_nuisances(problem, state);
  return fit::joint::joint_errors(problem, state, fit::joint::FixedBlock::given).residual_nT;
}

}  // namespace

double unseen_rms_nT(const PoseTable& table, const std::vector<std::string>& effects) {
  fit::joint::JointOptions options = with(effects);
  options.effects = must(fit::joint::profile_search(table, options));
  return check_rms_nT(table, options, must(fit::joint::fit_joint(table, options)));
}

Unseen unseen(const PoseTable& table, const std::vector<std::string>& true_effects) {
  const criticism::search::ImproveReport report = must(criticism::search::improve(table, {}));
  Unseen out{.nothing_nT = unseen_rms_nT(table, {}),
             .oracle_nT = unseen_rms_nT(table, true_effects),
             .chi2 = report.fit.chi2,
             .dof = report.fit.dof,
             .rounds = static_cast<int>(report.rounds.size()),
             .added = {}};
  for (const calibration::CalibratedEffect& effect : report.fit.calibration.effects)
    out.added.push_back(effect.effect);
  out.improved_nT = unseen_rms_nT(table, out.added);
  return out;
}

Unseen unseen_of_law(const HiddenLaw& law, double d, int channel, std::uint64_t seed) {
  constexpr int kUnseen = 100;
  const int s = channel / 3, a = channel % 3;
  const double size = d * crb_of(law, s, a, seed);
  return unseen(hidden_run({.hidden = hide(law, s, a, size), .unseen = kUnseen}, seed), {spec_of(law, s, a)});
}

PoseTable rig_run(const rig::Scenario& scenario, std::size_t unseen, std::uint64_t seed) {
  rig::DesignOptions options{.tilt_limit_deg = scenario.tilt_limit_deg};
  options.random += unseen;
  rig::Design design = rig::run_of_157(options, seed);
  const std::size_t first = design.poses.size() - options.random;
  for (std::size_t k = 0; k < unseen; ++k) design.poses[first + k * options.random / unseen].set = "check";
  return rig::simulated_table(scenario, design, seed);
}

rig::Scenario paper_experiment() {
  const std::string path = mgtd::testing::source_path("tests/scenarios/paper_experiment.toml");
  auto scenario = rig::parse_scenario(mgtd::testing::whole_file(path), path);
  if (!scenario) throw std::runtime_error(scenario.error().front());
  return *std::move(scenario);
}

std::vector<std::string> paper_effects() {
  return {"site.gradient",
          "axis.offset.temperature",
          "axis.offset.temperature2",
          "axis.gain.temperature",
          "axis.gain.temperature2",
          "axis.orthogonality.temperature",
          "axis.orthogonality.temperature2",
          "axis.hysteresis@s2.y,w=0.1",
          "axis.hysteresis@s4.x,w=0.2",
          "axis.cubic@s1.z",
          "axis.cubic@s3.x"};
}

}  // namespace mgtd::calib::testing
