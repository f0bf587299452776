// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/pose_model.h"

#include <gtest/gtest.h>

#include "calib/effects/library/library.h"
#include "calib/fit/joint/joint_setup.h"
#include "calib/fit/joint/joint_solver.h"
#include "tests/unit/calib/fit/simulated_poses.h"

namespace mgtd::calib::fit::joint {
namespace {

using testing::Simulation;

/// One effect per level, each with a genuine dependence on its input, to try the chain rule through every
/// level.
template <effects::Level kLevel>
class Probe final : public effects::EffectOf<Probe<kLevel>> {
 public:
  explicit Probe(double planted_error = 0)
      : planted_(planted_error), coefficients_(2, {.name = "c", .unit = "1"}) {}
  [[nodiscard]] std::string_view name() const override { return "probe"; }
  [[nodiscard]] effects::Level level() const override { return kLevel; }
  [[nodiscard]] const std::vector<effects::Coefficient>& coefficients() const override {
    return coefficients_;
  }
  [[nodiscard]] std::span<const int> at(int) const override { return at_; }
  [[nodiscard]] std::string_view missing(const Pose&) const override { return {}; }
  template <class S>
  void equation(const effects::Conditions&, int sensor, std::span<const S> in, std::span<const S> c,
                std::span<S> out) const {
    for (std::size_t o = 0; o < out.size(); ++o) {
      const S& a = in[o % in.size()];
      const S& b = in[(o + 1) % in.size()];
      out[o] = c[0] * sin(a * kScale) + (sensor + 1.0) * c[1] * a * b * kScale * kScale;
      if (kLevel == effects::Level::platform) out[o] += c[0] * in[3 + o];
      if constexpr (!std::is_same_v<S, double>) out[o].d *= 1 + planted_;
    }
  }

 private:
  static constexpr double kScale =
      kLevel == effects::Level::platform || kLevel == effects::Level::axis ? 2e-5 : 1;
  static double sin(double x) { return std::sin(x); }
  static effects::Jet sin(const effects::Jet& x) { return {std::sin(x.v), std::cos(x.v) * x.d}; }
  double planted_;
  std::vector<effects::Coefficient> coefficients_;
  std::vector<int> at_{0, 1};
};

struct Case {
  PoseTable table;
  JointProblem problem;
  JointState state;
};

/// What a reference beside the table reads, turned against it, in a field that moves by a few degrees.
void add_reference(const Simulation& sim, PoseTable& table) {
  std::mt19937_64 rng(5);
  std::normal_distribution<double> normal;
  const double ci = std::cos(sim.inclination_rad);
  const Eigen::Vector3d B_S_nT =
      sim.f_nT * Eigen::Vector3d{ci * std::cos(sim.declination_rad), ci * std::sin(sim.declination_rad),
                                 std::sin(sim.inclination_rad)};
  for (Pose& pose : table.poses)
    pose.ref_nT =
        testing::passive(0.7, 1) * (B_S_nT + 2000 * Eigen::Vector3d{normal(rng), normal(rng), normal(rng)});
}

Case make_case(std::vector<effects::EffectPtr> effects, bool with_angles, bool beside = false) {
  Case c;
  const Simulation sim{.with_angles = with_angles};
  c.table = simulate(sim, 12, 30, 3);
  if (beside) add_reference(sim, c.table);
  JointOptions options;
  auto problem = joint_problem(c.table, options);
  auto state = joint_start(*problem, 53'907);
  problem->effects = std::move(effects);
  c.state = *state;
  c.state.coefficients = Eigen::VectorXd::LinSpaced(problem->coefficients(), 0.01, 0.02);
  c.problem = *problem;
  return c;
}

Channels predict(const Case& c, const JointState& state, const Nuisance& nuisance, double& f_nT) {
  PoseLinear out;
  PoseModel(c.problem, state).linearise(c.problem.poses[20], nuisance, out);
  f_nT = out.f_nT;
  return out.y_nT;
}

/// Steps tried for each variable: rounding and curvature leave different ones usable for radians, nanotesla
/// and nT/m.
constexpr std::array kSteps{1.0, 1e-2, 1e-3, 1e-4, 1e-5};
// At the best step truncation (h^2) and rounding (1e-16 * 5e4 nT / (h * column)) meet near 1e-8 relative.
constexpr double kTolerance = 1e-7;

struct Column {
  Channels y{Channels::Zero(sensor::kChannels)};
  double f{0};
};

/// Difference between a Jacobian column and central differences at the best step, relative to the column's
/// size.
template <class Move>
double derivative_error(const Case& c, const Column& column, const Move& move) {
  double best = std::numeric_limits<double>::infinity();
  for (const double h : kSteps) {
    double f_up = 0, f_down = 0;
    const auto [state_up, x_up] = move(h);
    const auto [state_down, x_down] = move(-h);
    const Channels difference =
        (predict(c, state_up, x_up, f_up) - predict(c, state_down, x_down, f_down)) / (2 * h);
    const double f_difference = (f_up - f_down) / (2 * h);
    const double scale = std::max({difference.norm(), std::abs(f_difference), column.y.norm(), 1e-3});
    best =
        std::min(best, std::max((column.y - difference).norm(), std::abs(column.f - f_difference)) / scale);
  }
  return best;
}

double worst_derivative(const Case& c) {
  const Nuisance x = c.state.nuisances[20] + 0.01 * Nuisance::Ones();
  PoseLinear linear;
  PoseModel(c.problem, c.state).linearise(c.problem.poses[20], x, linear);
  double worst = 0;
  for (int slot = 0; slot < c.problem.fixed(); ++slot) {
    Column column;
    if (slot < FixedSlots{}.sensor_block()) {
      const int row = 3 * (slot / sensor::kSensorParameters);
      column.y.segment<3>(row) = linear.d_sensor.block<3, 1>(row, slot % sensor::kSensorParameters);
    } else {
      const int global = slot - FixedSlots{}.sensor_block();
      column = {.y = linear.d_global.col(global), .f = linear.f_global[global]};
    }
    worst = std::max(worst, derivative_error(c, column, [&](double h) {
                       return std::pair(c.state.moved(h * Eigen::VectorXd::Unit(c.problem.fixed(), slot)), x);
                     }));
  }
  for (int j = 0; j < kNuisances; ++j) {
    const Column column{linear.d_nuisance.col(j), linear.f_nuisance[j]};
    worst = std::max(worst, derivative_error(c, column, [&](double h) {
                       return std::pair(c.state, Nuisance(x + h * Nuisance::Unit(j)));
                     }));
  }
  return worst;
}

template <effects::Level kLevel>
effects::EffectPtr probe(double planted = 0) {
  return std::make_shared<const Probe<kLevel>>(planted);
}

TEST(PoseModel, DerivativesAreThoseOfTheModel) {
  EXPECT_LT(worst_derivative(make_case({}, true)), kTolerance);
  EXPECT_LT(worst_derivative(make_case({}, false)), kTolerance);
  EXPECT_LT(worst_derivative(make_case({*effects::library::make_effect("site.gradient")}, true)), kTolerance);
}

TEST(PoseModel, DerivativesWithAReferenceBesideTheTableAreThoseOfTheModel) {
  EXPECT_LT(worst_derivative(make_case({}, true, true)), kTolerance);
  EXPECT_LT(worst_derivative(make_case({probe<effects::Level::reference>(), probe<effects::Level::table>(),
                                        probe<effects::Level::site>(), probe<effects::Level::platform>()},
                                       true, true)),
            kTolerance);
}

TEST(PoseModel, TheTurnOfAReferenceAboutTheFieldMovesThePosesOfAnotherDirectionOnly) {
  Case c = make_case({}, true, true);
  PoseLinear linear;
  const auto by_turn = [&] {
    PoseModel(c.problem, c.state).linearise(c.problem.poses[20], c.state.nuisances[20], linear);
    return linear.d_global.col(2).norm();
  };
  EXPECT_GT(by_turn(), 100);
  c.problem.poses[20].reference_nT = 5e4 * c.state.R_SR->transpose() * c.state.direction;
  EXPECT_LT(by_turn(), 1e-6);
}

TEST(PoseModel, DerivativesHoldThroughEveryLevel) {
  EXPECT_LT(worst_derivative(make_case({probe<effects::Level::site>()}, true)), kTolerance);
  EXPECT_LT(worst_derivative(make_case({probe<effects::Level::table>()}, true)), kTolerance);
  EXPECT_LT(worst_derivative(make_case({probe<effects::Level::platform>()}, true)), kTolerance);
  EXPECT_LT(worst_derivative(make_case({probe<effects::Level::axis>()}, true)), kTolerance);
  EXPECT_LT(worst_derivative(make_case({probe<effects::Level::reference>()}, true)), kTolerance);
  EXPECT_LT(worst_derivative(make_case({probe<effects::Level::reference>(), probe<effects::Level::table>(),
                                        probe<effects::Level::site>()},
                                       true)),
            kTolerance);
  EXPECT_LT(worst_derivative(make_case({probe<effects::Level::axis>(), probe<effects::Level::table>(),
                                        probe<effects::Level::site>(), probe<effects::Level::platform>()},
                                       true)),
            kTolerance);
  EXPECT_LT(
      worst_derivative(make_case({probe<effects::Level::platform>(), probe<effects::Level::axis>()}, false)),
      kTolerance);
}

TEST(PoseModel, PlantedDerivativeErrorIsCaught) {
  EXPECT_GT(worst_derivative(make_case({probe<effects::Level::site>(0.01)}, true)), 100 * kTolerance);
  EXPECT_GT(worst_derivative(make_case({probe<effects::Level::axis>(0.01)}, true)), 100 * kTolerance);
}

/// Without effects of the axes a reading is what its axis sees and its offset.
TEST(PoseModel, TellsWhatTheAxesSee) {
  for (const bool with_angles : {true, false}) {
    for (const bool beside : {false, true}) {
      if (beside && !with_angles) continue;
      std::vector<effects::EffectPtr> probes{std::make_shared<Probe<effects::Level::platform>>()};
      if (with_angles) {
        probes.push_back(std::make_shared<Probe<effects::Level::table>>());
        probes.push_back(std::make_shared<Probe<effects::Level::site>>());
      }
      const Case c = make_case(std::move(probes), with_angles, beside);
      const JointPose& pose = c.problem.poses[20];
      double f_nT = 0;
      Channels expected = predict(c, c.state, c.state.nuisances[20], f_nT);
      for (int i = 0; i < c.problem.sensors(); ++i)
        expected.segment<3>(3 * i) -= c.state.sensors[static_cast<std::size_t>(i)].offset_nT;
      const Channels seen = PoseModel(c.problem, c.state).axis_inputs_nT(pose, c.state.nuisances[20]);
      EXPECT_LT((seen - expected).norm(), 1e-9 * expected.norm()) << with_angles << beside;
    }
  }
}

}  // namespace
}  // namespace mgtd::calib::fit::joint
