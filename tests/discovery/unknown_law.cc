// SPDX-License-Identifier: Apache-2.0
#include "tests/discovery/unknown_law.h"

#include <cmath>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>

namespace mgtd::calib::testing {
namespace {

constexpr std::size_t kSensor = 2;
constexpr int kAxis = 2;
constexpr double kField_nT = 50'000;

double uniform(std::mt19937_64& rng, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(rng);
}

double T_of(const Pose& p) { return *p.T_degC[kSensor]; }
double hours(const Pose& p) { return *p.t_s / 3600; }

/// A number of a pose and a run alone.
double number_of(int pose, std::uint64_t salt) {
  std::mt19937_64 rng(static_cast<std::uint64_t>(pose) * 7919 + salt);
  return std::normal_distribution<double>()(rng);
}
double motor_A(const Pose& p, std::uint64_t seed) { return 0.5 + 0.2 * number_of(p.number, seed); }

/// Values at 400 poses, drawn once.
template <class Step>
AxisLaw by_pose(std::mt19937_64& rng, Step step) {
  auto values = std::make_shared<std::map<int, double>>();
  double now = 0;
  for (int k = 0; k < 400; ++k) (*values)[k] = now = step(rng, now);
  return [values](const Pose& p, const Eigen::Vector3d&) { return values->at(p.number); };
}

std::vector<UnknownLaw> make_laws() {
  std::vector<UnknownLaw> out;
  const auto add = [&](std::string name, std::string truth, std::string covariate, auto draw) {
    out.push_back({std::move(name), std::move(truth), std::move(covariate), std::move(draw)});
  };
  add("third harmonic of azimuth", R"(.*3\*azimuth_deg\).*)", "azimuth_deg",
      [](std::mt19937_64& rng) -> AxisLaw {
        const double phase = uniform(rng, 0, 2 * std::numbers::pi);
        return
            [phase](const Pose& p, const Eigen::Vector3d&) { return std::sin(3 * *p.azimuth_rad + phase); };
      });
  add("fourth power of the reading", R"(z\^4)", "s3.z", [](std::mt19937_64&) -> AxisLaw {
    return [](const Pose&, const Eigen::Vector3d& v) { return std::pow(v[kAxis] / kField_nT, 4); };
  });
  add("size of the reading", R"(abs\(z\))", "s3.z", [](std::mt19937_64&) -> AxisLaw {
    return [](const Pose&, const Eigen::Vector3d& v) { return std::abs(v[kAxis] / kField_nT); };
  });
  add("saturation tanh(z/w)", R"(tanh\(z/.*)", "s3.z", [](std::mt19937_64& rng) -> AxisLaw {
    const double w = uniform(rng, 0.05, 0.4);
    return [w](const Pose&, const Eigen::Vector3d& v) { return std::tanh(v[kAxis] / kField_nT / w); };
  });
  add("oscillation in time", R"(a\*sin\(2\*pi\*t_h.*)", "t_h", [](std::mt19937_64& rng) -> AxisLaw {
    const double period_h = uniform(rng, 0.05, 0.5), phase = uniform(rng, 0, 2 * std::numbers::pi);
    return [=](const Pose& p, const Eigen::Vector3d&) {
      return std::sin(2 * std::numbers::pi * hours(p) / period_h + phase);
    };
  });
  add("warm-up exp(-t/tau)", R"(exp\(-3600\*t_h/.*)", "t_h", [](std::mt19937_64& rng) -> AxisLaw {
    const double tau_h = uniform(rng, 0.08, 0.4);
    return [tau_h](const Pose& p, const Eigen::Vector3d&) { return std::exp(-hours(p) / tau_h); };
  });
  add("temperature times time", R"(.*\*.*)", "t_h, s3_T_degC", [](std::mt19937_64&) -> AxisLaw {
    return [](const Pose& p, const Eigen::Vector3d&) { return (T_of(p) - 21) * hours(p); };
  });
  add("cube of the temperature", R"(.*T.*\^3)", "s3_T_degC", [](std::mt19937_64& rng) -> AxisLaw {
    const double centre = uniform(rng, 20, 22);
    return [centre](const Pose& p, const Eigen::Vector3d&) { return std::pow(T_of(p) - centre, 3); };
  });
  add("knee in the temperature", R"(max\(0, .*T.*\))", "s3_T_degC", [](std::mt19937_64& rng) -> AxisLaw {
    const double knee = uniform(rng, 19.5, 22.5);
    return [knee](const Pose& p, const Eigen::Vector3d&) { return std::max(0.0, T_of(p) - knee); };
  });
  add("current times reading", R"(z\*\(?motor_A.*)", "s3.z, motor_A", [](std::mt19937_64&) -> AxisLaw {
    return [](const Pose& p, const Eigen::Vector3d& v) {
      return p.covariates.at("motor_A") * v[kAxis] / kField_nT;
    };
  });
  add("square of the current", R"(.*motor_A.*\^2)", "motor_A", [](std::mt19937_64&) -> AxisLaw {
    return
        [](const Pose& p, const Eigen::Vector3d&) { return std::pow(p.covariates.at("motor_A") - 0.5, 2); };
  });
  add("pitch", R"(pitch_deg|sind\(pitch_deg\))", "pitch_deg", [](std::mt19937_64&) -> AxisLaw {
    return [](const Pose& p, const Eigen::Vector3d&) { return *p.pitch_rad; };
  });
  add("parity of the pose", R"(cos\(pi\*pose\))", "pose", [](std::mt19937_64&) -> AxisLaw {
    return [](const Pose& p, const Eigen::Vector3d&) { return p.number % 2 == 0 ? 1.0 : -1.0; };
  });
  add("product of two axes", R"(x\*y)", "s3.x, s3.y", [](std::mt19937_64&) -> AxisLaw {
    return [](const Pose&, const Eigen::Vector3d& v) { return v[0] * v[1] / kField_nT / kField_nT; };
  });
  return out;
}

std::vector<UnknownLaw> make_lawless() {
  std::vector<UnknownLaw> out;
  out.push_back({"offset that walks", "", "", [](std::mt19937_64& rng) {
                   return by_pose(rng, [](std::mt19937_64& r, double now) {
                     return now + std::normal_distribution<double>()(r);
                   });
                 }});
  out.push_back({"unrecorded load, on or off", "", "", [](std::mt19937_64& rng) {
                   return by_pose(rng, [](std::mt19937_64& r, double) { return r() % 2 == 0 ? 1.0 : 0.0; });
                 }});
  out.push_back({"24 times a turn", "", "", [](std::mt19937_64& rng) -> AxisLaw {
                   const double phase = uniform(rng, 0, 2 * std::numbers::pi);
                   return [phase](const Pose& p, const Eigen::Vector3d&) {
                     return std::sin(24 * *p.azimuth_rad + phase);
                   };
                 }});
  out.push_back({"temperature times third harmonic", "", "", [](std::mt19937_64&) -> AxisLaw {
                   return [](const Pose& p, const Eigen::Vector3d&) {
                     return (T_of(p) - 21) * std::sin(3 * *p.azimuth_rad);
                   };
                 }});
  return out;
}

}  // namespace

const std::vector<UnknownLaw>& unknown_laws() {
  static const std::vector<UnknownLaw> all = make_laws();
  return all;
}
const std::vector<UnknownLaw>& lawless() {
  static const std::vector<UnknownLaw> all = make_lawless();
  return all;
}

PoseTable law_run(const LawRun& run, std::uint64_t seed) {
  HiddenRun hidden = run.noise;
  hidden.hidden = {};
  PoseTable table = hidden_run(hidden, seed);
  for (Pose& pose : table.poses) {
    pose.covariates["motor_A"] = motor_A(pose, seed);
    pose.covariates["battery_V"] = 12.6 - 0.4 * hours(pose);
  }
  if (!run.law) return table;
  const Simulation sim;
  std::vector<double> values;
  double mean = 0, squares = 0;
  for (const Pose& pose : table.poses) {
    values.push_back(run.law(pose, pose.y_nT[kSensor] - sim.rig[kSensor].offset_nT));
    mean += values.back() / static_cast<double>(table.poses.size());
  }
  for (const double x : values) squares += (x - mean) * (x - mean);
  const double size = run.d * run.noise.noise_nT / std::sqrt(squares);
  for (std::size_t k = 0; k < values.size(); ++k) table.poses[k].y_nT[kSensor][kAxis] += size * values[k];
  return table;
}

}  // namespace mgtd::calib::testing
