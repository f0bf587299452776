// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <stdexcept>
#include <string>

#include "calib/discovery/grammar.h"
#include "calib/discovery/law_search.h"
#include "calib/fit/joint/joint_fit.h"
#include "calib/fit/joint/joint_report.h"
#include "tests/blind/hidden_run.h"

/// A run with something hidden in it, fitted and laid out for a search.
namespace mgtd::calib::discovery::testing {

template <class T>
T must(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().text());
  return *std::move(result);
}

inline fit::joint::JointFit fitted(const PoseTable& table) {
  return must(fit::joint::fit_joint(table, must(fit::joint::profiled_options(table, fit::FitOptions{}))));
}

/// The current at a pose, unlike that at any other.
inline double motor_A(const Pose& pose) {
  std::mt19937_64 rng(static_cast<std::uint64_t>(pose.number) * 7919 + 77);
  return 0.5 + 0.2 * std::normal_distribution<double>()(rng);
}

/// The run of hidden_run.h with a current and a battery beside it.
inline PoseTable run_with(const calib::testing::HiddenRun& hidden, std::uint64_t seed) {
  PoseTable table = calib::testing::hidden_run(hidden, seed);
  for (Pose& pose : table.poses) {
    pose.covariates["motor_A"] = motor_A(pose);
    pose.covariates["battery_V"] = 12.6 - 0.4 * *pose.t_s / 3600;
  }
  return table;
}

struct Scene {
  PoseTable table;
  fit::joint::JointFit fit;
  criticism::tests::Residual residual;
  ChannelSums sums;
  LawInputs inputs;
  Grammar formulas;

  Scene(PoseTable run, double rho)
      : table(std::move(run)),
        fit(fitted(table)),
        residual(fit.problem, fit.state, rho),
        sums(fit, residual),
        inputs(must(LawInputs::of(fit, table))),
        formulas(grammar(inputs)) {}
};

/// On the heap, because a fit points into its table.
inline std::unique_ptr<Scene> scene(const calib::testing::HiddenRun& hidden, std::uint64_t seed,
                                    double rho = 0) {
  return std::make_unique<Scene>(run_with(hidden, seed), rho);
}

}  // namespace mgtd::calib::discovery::testing
