// SPDX-License-Identifier: Apache-2.0
#include "tests/discovery/weather.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace mgtd::calib::testing {
namespace {

class Swing : public Weather {
 public:
  explicit Swing(double length_s) : length_s_(length_s) {}

  [[nodiscard]] double T_degC(std::size_t sensor, double t_s) const override {
    return kMean_degC + kSwing_degC * std::sin(phase_rad(sensor, t_s));
  }
  [[nodiscard]] double rate_degC_per_h(std::size_t sensor, double t_s) const override {
    return kSwing_degC * std::cos(phase_rad(sensor, t_s)) * kTurn_rad / length_s_ * 3600;
  }
  [[nodiscard]] double lagging_T_degC(std::size_t sensor, double t_s, double tau_s) const override {
    const double late_rad = std::atan(kTurn_rad / length_s_ * tau_s),
                 amplitude = kSwing_degC * std::cos(late_rad);
    const auto settled = [&](double t) { return amplitude * std::sin(phase_rad(sensor, t) - late_rad); };
    const double before = T_degC(sensor, 0) - kMean_degC - settled(0);
    return kMean_degC + settled(t_s) + before * std::exp(-t_s / tau_s);
  }

 private:
  static constexpr double kTurn_rad = 5, kAhead_rad = 0.3, kSwing_degC = 3, kMean_degC = 21;

  [[nodiscard]] double phase_rad(std::size_t sensor, double t_s) const {
    return kTurn_rad * t_s / length_s_ + kAhead_rad * static_cast<double>(sensor);
  }

  double length_s_;
};

/// Second by second: the room, and each head behind it.
class Rise : public Weather {
 public:
  Rise(double length_s, std::uint64_t seed) {
    constexpr double kStart_degC = 18, kRise_degC = 6, kRoom_s = 1500;  // one less than a third of a run
    constexpr double kScatter_degC = 0.4, kMemory_s = 600;
    std::mt19937_64 rng(seed);
    std::normal_distribution<double> normal;
    const double kept = std::exp(-1 / kMemory_s), fresh = kScatter_degC * std::sqrt(1 - kept * kept);
    double doors = 0;
    for (double t = 0; t <= length_s + 1; ++t) {
      room_.push_back(kStart_degC + kRise_degC * (1 - std::exp(-t / kRoom_s)) + doors);
      doors = kept * doors + fresh * normal(rng);
    }
    for (std::size_t i = 0; i < heads_.size(); ++i) {
      pace_s_[i] = std::uniform_real_distribution<double>(60, 400)(rng);
      heads_[i] = behind(room_, pace_s_[i]);
    }
  }

  [[nodiscard]] double T_degC(std::size_t sensor, double t_s) const override {
    return at(heads_.at(sensor), t_s);
  }
  [[nodiscard]] double rate_degC_per_h(std::size_t sensor, double t_s) const override {
    return (at(room_, t_s) - T_degC(sensor, t_s)) / pace_s_.at(sensor) * 3600;
  }
  [[nodiscard]] double lagging_T_degC(std::size_t sensor, double t_s, double tau_s) const override {
    return at(behind(heads_.at(sensor), tau_s), t_s);
  }

 private:
  using Seconds = std::vector<double>;

  static Seconds behind(const Seconds& leader, double tau_s) {
    Seconds out{leader.front()};
    const double share = 1 - std::exp(-1 / tau_s);
    for (std::size_t k = 1; k < leader.size(); ++k)
      out.push_back(out.back() + share * (leader[k - 1] - out.back()));
    return out;
  }

  static double at(const Seconds& values, double t_s) {
    const double whole = std::floor(std::clamp(t_s, 0.0, static_cast<double>(values.size() - 2)));
    const auto k = static_cast<std::size_t>(whole);
    return values[k] + (t_s - whole) * (values[k + 1] - values[k]);
  }

  Seconds room_;
  std::array<Seconds, 4> heads_;
  std::array<double, 4> pace_s_{};
};

}  // namespace

WeatherPtr weather(Course course, double length_s, std::uint64_t seed) {
  if (course == Course::swing) return std::make_shared<Swing>(length_s);
  return std::make_shared<Rise>(length_s, seed);
}

}  // namespace mgtd::calib::testing
