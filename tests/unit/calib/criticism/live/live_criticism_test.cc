// SPDX-License-Identifier: Apache-2.0
// What live criticism misses and what it cries about, on streams with fixed seeds. The samples of a part of a
// block are what counts, so a stream of a few samples a second with the noise of so many means stands for one
// at 50 Hz, and hundreds of days can be looked at.
#include "calib/criticism/live/live_criticism.h"

#include <gmock/gmock.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <functional>
#include <random>

#include "calib/report/live_report.h"

namespace mgtd::calib::criticism::live {
namespace {

using ::testing::HasSubstr;

constexpr double kF_nT = 50'000, kDay_s = 86'400;

/// 0.3 nT a sample, scales and angles known to 2e-6, offsets to 0.1 nT: a good run of 157 poses.
calibration::Calibration calibration(const sensor::Geometry& array = {}) {
  calibration::Calibration c;
  const auto sensors = static_cast<int>(array.sensors());
  c.geometry = array;
  c.sensors = PerSensor<sensor::SensorModel>(array.sensors());
  c.sample_noise_nT.setConstant(sensors, 3, 0.3);
  c.pose_noise_nT.setZero(sensors, 3);
  c.covariance.setZero(sensors * sensor::kSensorParameters, sensors * sensor::kSensorParameters);
  c.covariance.diagonal().setConstant(4e-12);
  for (int i = 0; i < sensors; ++i)
    c.covariance.diagonal().segment<3>(sensor::kSensorParameters * i + sensor::ix).setConstant(0.01);
  c.seal();
  return c;
}

/// The corners of a cube: sixteen closure numbers.
sensor::Geometry cube() {
  PerSensor<Eigen::Vector3d> corners(0);
  for (int k = 0; k < 8; ++k)
    corners.push_back(0.2 *
                      Eigen::Vector3d(k % 2 == 0 ? 1 : -1, k / 2 % 2 == 0 ? 1 : -1, k / 4 == 0 ? 1 : -1));
  return sensor::Geometry(corners);
}

/// In the first four closure numbers.
using Truth = std::function<Eigen::Vector4d(double t_s, const Eigen::Vector3d& b, double T)>;

struct Life {
  double rate_hz{1}, days{1};
  double rho{0};      ///< of the noise from sample to sample
  double student{0};  ///< degrees of freedom; 0: Gaussian
  double turn_every_s{600};
  double T_amplitude_degC{4};
  Truth truth{};
  sensor::Geometry array{};
};

struct Seen {
  int suspect{0}, near_source{0};  ///< times that the state was entered
  double first_s{0};               ///< of either
  std::string measured;
};

/// A stream whose calibration is wrong by as much as it states, and by `truth` beside.
Seen live(const Life& life, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::student_t_distribution<double> student(std::max(3.0, life.student));
  const double student_sd = life.student > 0 ? std::sqrt(life.student / (life.student - 2)) : 1;
  calibration::Calibration c = calibration(life.array);
  // As many samples as at 50 Hz are in one of these.
  c.sample_noise_nT /= std::sqrt(50 / life.rate_hz);
  const ClosurePrior prior = closure_prior(c);
  ClosureErrors p = prior.parameters;
  p.diagonal().array() += 1e-18;
  Eigen::VectorXd draw(p.rows());
  for (double& v : draw) v = normal(random);
  const Eigen::MatrixXd W = (p.llt().matrixL() * draw).reshaped(prior.numbers(), 4);
  const Eigen::MatrixXd noise = prior.sample_noise.llt().matrixL();

  LiveCriticism criticism(c);
  Seen seen;
  Eigen::Vector3d b(20'000, 0, 45'826);
  Eigen::VectorXd colour = Eigen::VectorXd::Zero(prior.numbers());
  double turned_s = 0;
  const auto n = static_cast<std::int64_t>(life.days * kDay_s * life.rate_hz);
  for (std::int64_t k = 0; k < n; ++k) {
    const double t_s = (static_cast<double>(k) + 0.5) / life.rate_hz;
    if (t_s - turned_s >= life.turn_every_s) {
      turned_s = t_s;
      b = Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized() * kF_nT;
    }
    const double T = 20 + life.T_amplitude_degC * std::sin(2 * M_PI * t_s / kDay_s);
    Eigen::VectorXd white(prior.numbers());
    for (double& v : white) v = life.student > 0 ? student(random) / student_sd : normal(random);
    colour = life.rho * colour + std::sqrt(1 - life.rho * life.rho) * white;
    Eigen::Vector4d q;
    q << 1, b / kF_nT;
    Eigen::VectorXd closure = W * q + noise * colour;
    if (life.truth) closure.head<4>() += life.truth(t_s, b / kF_nT, T);
    const LiveState before = criticism.finding().state;
    if (!criticism.add({t_s, closure, b, T})) continue;
    const LiveState now = criticism.finding().state;
    if (now == before || (now != LiveState::suspect && now != LiveState::near_source)) continue;
    if (seen.suspect + seen.near_source == 0) seen.first_s = t_s;
    ++(now == LiveState::suspect ? seen.suspect : seen.near_source);
    seen.measured = report::live_report(criticism.finding()).measured;
  }
  return seen;
}

/// Less than one false alarm a day is asked for; none in 72 days says below 1 in 24 days with 95 %.
TEST(LiveCriticism, AnIntactCalibrationRaisesNoAlarm) {
  int alarms = 0;
  double days = 0;
  for (const double rho : {0.0, 0.8, 0.98}) {
    for (const double student : {0.0, 3.0}) {
      for (const double turn_every_s : {600.0, 1e9}) {
        Life life{.rate_hz = 1, .days = 6, .rho = rho, .student = student, .turn_every_s = turn_every_s};
        const Seen seen = live(life, 100 + static_cast<std::uint64_t>(days));
        alarms += seen.suspect + seen.near_source;
        days += life.days;
        EXPECT_EQ(seen.suspect + seen.near_source, 0)
            << "rho " << rho << " student " << student << " turns " << turn_every_s << ": " << seen.measured;
      }
    }
  }
  RecordProperty("false_alarms", alarms);
  RecordProperty("days", static_cast<int>(days));
  EXPECT_EQ(alarms, 0) << "in " << days << " days";
}

/// The noise of a real stream: 50 samples a second, correlated over one.
TEST(LiveCriticism, NorDoesItAtFiftySamplesASecond) {
  const Seen seen = live({.rate_hz = 50, .days = 0.5, .rho = 0.98, .turn_every_s = 120}, 7);
  EXPECT_EQ(seen.suspect + seen.near_source, 0) << seen.measured;
}

struct Power {
  int seen{0}, named{0};
};

Power power(const Life& life, const std::string& name) {
  Power out;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const Seen seen = live(life, seed);
    if (seen.suspect > 0) ++out.seen;
    if (seen.measured.find(name) != std::string::npos) ++out.named;
  }
  return out;
}

/// One axis with 0.3 nT/degC (centre: half of it), 8 degC from night to noon, in a day.
TEST(LiveCriticism, SeesATemperature) {
  const Life life{.days = 1, .rho = 0.8, .truth = [](double, const Eigen::Vector3d&, double T) {
                    return Eigen::Vector4d(0, 0, 0, 0.15 * (T - 20));
                  }};
  const Power p = power(life, "follows temperature");
  EXPECT_GE(p.seen, 11);
  EXPECT_GE(p.named, 11);
}

/// 3 nT a day at one temperature: a quarter of that in the centre.
TEST(LiveCriticism, SeesADrift) {
  const Life life{
      .days = 1, .rho = 0.8, .T_amplitude_degC = 0, .truth = [](double t_s, const Eigen::Vector3d&, double) {
        return Eigen::Vector4d(0, 1.5 * t_s / kDay_s, 0, 0);
      }};
  const Power p = power(life, "follows time");
  EXPECT_GE(p.seen, 11);
  EXPECT_GE(p.named, 11);
}

/// A head turned by 10 arc seconds: 2.4 nT at right angles.
TEST(LiveCriticism, SeesATurnedHeadWithinHalfAnHour) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Seen seen = live({.days = 0.25,
                            .rho = 0.8,
                            .turn_every_s = 120,
                            .truth = [](double, const Eigen::Vector3d& u,
                                        double) { return Eigen::Vector4d(0, -1.2 * u.y(), 1.2 * u.x(), 0); }},
                           seed);
    EXPECT_GT(seen.suspect, 0) << seed;
    EXPECT_THAT(seen.measured, HasSubstr("follows the attitude")) << seed;
  }
}

/// A car stands beside the array for five minutes: it is the field, not the calibration.
TEST(LiveCriticism, ASourceNearbyIsNoFaultOfTheCalibration) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Seen seen =
        live({.days = 0.125,
              .rho = 0.8,
              .turn_every_s = 900,
              .truth =
                  [](double t_s, const Eigen::Vector3d&, double) {
                    const bool there = t_s > 5000 && t_s < 5300;
                    return there ? Eigen::Vector4d(3, 1, -2, 4) : Eigen::Vector4d::Zero().eval();
                  }},
             seed);
    EXPECT_EQ(seen.suspect, 0) << seed << seen.measured;
    EXPECT_EQ(seen.near_source, 1) << seed;
    EXPECT_NEAR(seen.first_s, 5020, 15) << seed;
  }
}

/// Sixteen closure numbers instead of four.
TEST(LiveCriticism, ACubeOfEightIsJudgedLikeTheCross) {
  int alarms = 0;
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    const Seen seen = live({.days = 0.5, .rho = 0.8, .array = cube()}, seed);
    alarms += seen.suspect + seen.near_source;
  }
  EXPECT_EQ(alarms, 0) << "in a day";
  const Seen warm = live({.days = 1,
                          .rho = 0.8,
                          .truth = [](double, const Eigen::Vector3d&,
                                      double T) { return Eigen::Vector4d(0, 0, 0.25 * (T - 20), 0); },
                          .array = cube()},
                         1);
  EXPECT_THAT(warm.measured, HasSubstr("closure number 3 follows temperature"));
  const auto car = [](double t_s, const Eigen::Vector3d&, double) {
    return t_s > 5000 && t_s < 5300 ? Eigen::Vector4d(3, 1, -2, 4) : Eigen::Vector4d::Zero().eval();
  };
  const Seen near = live({.days = 0.125, .rho = 0.8, .turn_every_s = 900, .truth = car, .array = cube()}, 1);
  EXPECT_EQ(near.suspect, 0) << near.measured;
  EXPECT_EQ(near.near_source, 1);
  EXPECT_THAT(near.measured, HasSubstr("root mean square of 16 numbers"));
}

TEST(LiveCriticism, HasNothingToSayWithoutClosure) {
  EXPECT_EQ(
      LiveCriticism(calibration(sensor::Geometry(PerSensor<Eigen::Vector3d>{{0, 0, 0}}))).finding().state,
      LiveState::none);
  const PerSensor<Eigen::Vector3d> pair{{0, 0, 0.2}, {0, 0, -0.2}};
  EXPECT_EQ(LiveCriticism(calibration(sensor::Geometry(pair))).finding().state, LiveState::none);
}

TEST(LiveCriticism, HasNothingToSayWithoutNoise) {
  calibration::Calibration c = calibration();
  c.sample_noise_nT(2, 1) = 0;
  c.seal();
  EXPECT_EQ(LiveCriticism(c).finding().state, LiveState::none);
  EXPECT_EQ(LiveCriticism().finding().state, LiveState::none);
  EXPECT_EQ(LiveCriticism(calibration()).finding().state, LiveState::learning);
}

}  // namespace
}  // namespace mgtd::calib::criticism::live
