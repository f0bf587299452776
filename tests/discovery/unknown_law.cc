// SPDX-License-Identifier: Apache-2.0
#include "tests/discovery/unknown_law.h"

#include <cmath>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>

namespace mgtd::calib::testing {
namespace {

constexpr double kField_nT = 50'000;

double uniform(std::mt19937_64& rng, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(rng);
}

double T_of(const Pose& p) { return *p.T_degC[kLawSensor]; }
double hours(const Pose& p) { return *p.t_s / 3600; }
double x_of(const Eigen::Vector3d& v_nT) { return v_nT[kLawAxis] / kField_nT; }

/// A number of a pose and a run alone.
double number_of(int pose, std::uint64_t salt) {
  std::mt19937_64 rng(static_cast<std::uint64_t>(pose) * 7919 + salt);
  return std::normal_distribution<double>()(rng);
}
double motor_A(const Pose& p, std::uint64_t seed) { return 0.5 + 0.2 * number_of(p.number, seed); }
double battery_V(const Pose& p, std::uint64_t seed) {
  return 12.6 - 0.25 * hours(p) - 0.1 * hours(p) * hours(p) + 0.005 * number_of(p.number, seed + 1);
}

/// Values at 400 poses, drawn once.
template <class Step>
AxisLaw by_pose(std::mt19937_64& rng, Step step) {
  auto values = std::make_shared<std::map<int, double>>();
  double now = 0;
  for (int k = 0; k < 400; ++k) (*values)[k] = now = step(rng, now);
  return [values](const Pose& p, const Eigen::Vector3d&) { return values->at(p.number); };
}

/// A law without numbers of its own.
auto plain(AxisLaw law) {
  return [law = std::move(law)](std::mt19937_64&, const WeatherPtr&) { return law; };
}

std::vector<UnknownLaw> make_laws() {
  using Random = std::mt19937_64;
  using Field = Eigen::Vector3d;
  return {
      {"third harmonic of azimuth", R"(.*3\*azimuth_deg\).*)", "azimuth_deg",
       [](Random& rng, const WeatherPtr&) -> AxisLaw {
         const double phase = uniform(rng, 0, 2 * std::numbers::pi);
         return [phase](const Pose& p, const Field&) { return std::sin(3 * *p.azimuth_rad + phase); };
       }},
      {"fourth power of the reading", R"(z\^4)", "s3.z",
       plain([](const Pose&, const Field& v) { return std::pow(x_of(v), 4); })},
      {"size of the reading", R"(abs\(z\))", "s3.z",
       plain([](const Pose&, const Field& v) { return std::abs(x_of(v)); })},
      {"saturation tanh(z/w)", R"(tanh\(z/.*)", "s3.z",
       [](Random& rng, const WeatherPtr&) -> AxisLaw {
         const double w = uniform(rng, 0.05, 0.4);
         return [w](const Pose&, const Field& v) { return std::tanh(x_of(v) / w); };
       }},
      {"oscillation in time", R"(a\*sin\(2\*pi\*t_h.*)", "t_h",
       [](Random& rng, const WeatherPtr&) -> AxisLaw {
         const double period_h = uniform(rng, 0.05, 0.5), phase = uniform(rng, 0, 2 * std::numbers::pi);
         return [=](const Pose& p, const Field&) {
           return std::sin(2 * std::numbers::pi * hours(p) / period_h + phase);
         };
       }},
      {"warm-up exp(-t/tau)", R"(exp\(-3600\*t_h/.*)", "t_h",
       [](Random& rng, const WeatherPtr&) -> AxisLaw {
         const double tau_h = uniform(rng, 0.08, 0.4);
         return [tau_h](const Pose& p, const Field&) { return std::exp(-hours(p) / tau_h); };
       }},
      {"thermal lag", R"(lag\(T, .*)", "s3_T_degC",
       [](Random& rng, const WeatherPtr& weather) -> AxisLaw {
         const double tau_s = uniform(rng, 200, 1500);
         return
             [=](const Pose& p, const Field&) { return weather->lagging_T_degC(kLawSensor, *p.t_s, tau_s); };
       }},
      {"rate of the temperature", R"(dT/dt)", "s3_T_degC",
       [](Random&, const WeatherPtr& weather) -> AxisLaw {
         return [=](const Pose& p, const Field&) { return weather->rate_degC_per_h(kLawSensor, *p.t_s); };
       }},
      {"temperature times time", R"(.*\*.*)", "t_h, s3_T_degC",
       plain([](const Pose& p, const Field&) { return (T_of(p) - 21) * hours(p); })},
      {"square of the battery's voltage", R"(.*battery_V.*\^2)", "battery_V",
       plain([](const Pose& p, const Field&) { return std::pow(p.covariates.at("battery_V") - 12.6, 2); })},
      {"current times reading", R"(z\*\(?motor_A.*)", "s3.z, motor_A",
       plain([](const Pose& p, const Field& v) { return p.covariates.at("motor_A") * x_of(v); })},
      {"knee in the temperature", R"(max\(0, .*T.*\))", "s3_T_degC",
       [](Random& rng, const WeatherPtr&) -> AxisLaw {
         const double knee = uniform(rng, 19.5, 22.5);
         return [knee](const Pose& p, const Field&) { return std::max(0.0, T_of(p) - knee); };
       }},
      {"pitch", R"(pitch_deg|sind\(pitch_deg\))", "pitch_deg",
       plain([](const Pose& p, const Field&) { return *p.pitch_rad; })},
      {"parity of the pose", R"(cos\(pi\*pose\))", "pose",
       plain([](const Pose& p, const Field&) { return p.number % 2 == 0 ? 1.0 : -1.0; })},
  };
}

std::vector<UnknownLaw> make_further_laws() {
  using Field = Eigen::Vector3d;
  return {
      {"cube of the temperature", R"(.*T.*\^3)", "s3_T_degC",
       [](std::mt19937_64& rng, const WeatherPtr&) -> AxisLaw {
         const double centre = uniform(rng, 20, 22);
         return [centre](const Pose& p, const Field&) { return std::pow(T_of(p) - centre, 3); };
       }},
      {"square of the current", R"(.*motor_A.*\^2)", "motor_A",
       plain([](const Pose& p, const Field&) { return std::pow(p.covariates.at("motor_A") - 0.5, 2); })},
      {"product of two axes", R"(x\*y)", "s3.x, s3.y",
       plain([](const Pose&, const Field& v) { return v[0] * v[1] / kField_nT / kField_nT; })},
  };
}

std::vector<UnknownLaw> make_lawless() {
  std::vector<UnknownLaw> out;
  out.push_back({"offset that walks", "", "", [](std::mt19937_64& rng, const WeatherPtr&) {
                   return by_pose(rng, [](std::mt19937_64& r, double now) {
                     return now + std::normal_distribution<double>()(r);
                   });
                 }});
  out.push_back({"unrecorded load, on or off", "", "", [](std::mt19937_64& rng, const WeatherPtr&) {
                   return by_pose(rng, [](std::mt19937_64& r, double) { return r() % 2 == 0 ? 1.0 : 0.0; });
                 }});
  out.push_back({"24 times a turn", "", "", [](std::mt19937_64& rng, const WeatherPtr&) -> AxisLaw {
                   const double phase = uniform(rng, 0, 2 * std::numbers::pi);
                   return [phase](const Pose& p, const Eigen::Vector3d&) {
                     return std::sin(24 * *p.azimuth_rad + phase);
                   };
                 }});
  out.push_back({"temperature times third harmonic", "", "", plain([](const Pose& p, const Eigen::Vector3d&) {
                   return (T_of(p) - 21) * std::sin(3 * *p.azimuth_rad);
                 })});
  return out;
}

}  // namespace

const std::vector<UnknownLaw>& unknown_laws() {
  static const std::vector<UnknownLaw> all = make_laws();
  return all;
}
const std::vector<UnknownLaw>& further_laws() {
  static const std::vector<UnknownLaw> all = make_further_laws();
  return all;
}
const std::vector<UnknownLaw>& lawless() {
  static const std::vector<UnknownLaw> all = make_lawless();
  return all;
}

RecordedRun recorded_run(const HiddenRun& run, Course course, std::uint64_t seed) {
  PoseTable table = hidden_run(run, seed);
  HiddenRun quiet = run;
  quiet.noise_nT = 0;
  const PoseTable noiseless = hidden_run(quiet, seed);
  WeatherPtr temperatures = weather(course, *table.poses.back().t_s, seed);
  for (std::size_t k = 0; k < table.poses.size(); ++k) {
    Pose& pose = table.poses[k];
    if (pose.set == "check") pose.y_nT = noiseless.poses[k].y_nT;
    for (std::size_t i = 0; i < 4; ++i)
      pose.T_degC[i] = temperatures->T_degC(i, *pose.t_s) + 0.01 * number_of(pose.number, seed + 2 + i);
    pose.covariates["motor_A"] = motor_A(pose, seed);
    pose.covariates["battery_V"] = battery_V(pose, seed);
  }
  return {std::move(table), std::move(temperatures)};
}

Eigen::VectorXd values_of(const AxisLaw& law, const PoseTable& table) {
  const Simulation sim;
  Eigen::VectorXd out(static_cast<Eigen::Index>(table.poses.size()));
  for (Eigen::Index k = 0; k < out.size(); ++k) {
    const Pose& pose = table.poses[static_cast<std::size_t>(k)];
    out[k] = law(pose, pose.y_nT[kLawSensor] - sim.rig[kLawSensor].offset_nT);
  }
  return out;
}

void add(const Eigen::VectorXd& values_nT, PoseTable& table) {
  for (Eigen::Index k = 0; k < values_nT.size(); ++k)
    table.poses[static_cast<std::size_t>(k)].y_nT[kLawSensor][kLawAxis] += values_nT[k];
}

}  // namespace mgtd::calib::testing
