// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "calib/criticism/tests/candidate_effect.h"
#include "tests/blind/hidden_run.h"

/// Candidate effects that share no code with the library.
namespace mgtd::calib::testing {

/// y += c f(pose, v, axis), one coefficient for each of the axes it is laid over.
class AxisLaw final : public effects::EffectOf<AxisLaw> {
 public:
  using Shape = std::function<double(const Pose&, double t_h, int sensor, double v)>;
  /// `groups[axis]`: which coefficient acts on each of the twelve; -1 none.
  AxisLaw(std::string name, Shape shape, std::array<int, 12> groups, std::vector<std::string> names)
      : name_(std::move(name)), shape_(std::move(shape)), groups_(groups) {
    for (std::string& n : names) coefficients_.push_back({.name = std::move(n), .unit = "nT"});
    for (std::size_t c = 0; c < 12; ++c) {
      auto& at = at_[c / 3];
      const int g = groups_[c];
      if (g >= 0 && std::find(at.begin(), at.end(), g) == at.end()) at.push_back(g);
    }
  }
  static effects::EffectPtr finest(const std::string& name, const Shape& shape) {
    std::vector<std::string> names;
    std::array<int, 12> groups{};
    for (int c = 0; c < 12; ++c) {
      names.push_back("s" + std::to_string(c / 3 + 1) + "." + "xyz"[c % 3]);
      groups[static_cast<std::size_t>(c)] = c;
    }
    return std::make_shared<const AxisLaw>(name, shape, groups, names);
  }
  [[nodiscard]] std::string_view name() const override { return name_; }
  [[nodiscard]] effects::Level level() const override { return effects::Level::axis; }
  [[nodiscard]] const std::vector<effects::Coefficient>& coefficients() const override {
    return coefficients_;
  }
  [[nodiscard]] std::span<const int> at(int sensor) const override {
    return at_[static_cast<std::size_t>(sensor)];
  }
  [[nodiscard]] std::string_view missing(const Pose&) const override { return {}; }

  template <class S>
  void equation(const effects::Conditions& at, int sensor, std::span<const S> v, std::span<const S> c,
                std::span<S> out) const {
    const auto& own = at_[static_cast<std::size_t>(sensor)];
    for (int a = 0; a < 3; ++a) {
      const auto axis = static_cast<std::size_t>(a);
      const int g = groups_[static_cast<std::size_t>(3 * sensor + a)];
      out[axis] = S(0.0);
      const auto slot = std::find(own.begin(), own.end(), g);
      if (g < 0) continue;
      out[axis] = c[static_cast<std::size_t>(slot - own.begin())] *
                  shape_(at.pose, at.t_h, sensor, sensor::value_of(v[axis]));
    }
  }

 private:
  std::string name_;
  Shape shape_;
  std::array<int, 12> groups_;
  std::vector<effects::Coefficient> coefficients_;
  std::array<std::vector<int>, 4> at_;
};

inline criticism::tests::CandidateEffect candidate_effect(const std::string& name,
                                                          const AxisLaw::Shape& shape) {
  criticism::tests::CandidateEffect out{
      .name = name, .variants = {AxisLaw::finest(name, shape)}, .values = {std::nullopt}};
  out.hypotheses = criticism::tests::hypotheses_of(*out.variants.front(), kSensors);
  out.make = [name, shape](const criticism::tests::Hypothesis* part,
                           const std::optional<double>&) -> Result<effects::EffectPtr> {
    if (part == nullptr) return AxisLaw::finest(name, shape);
    const criticism::tests::Hypothesis& h = *part;
    std::array<int, 12> groups{};
    for (Eigen::Index c = 0; c < 12; ++c) {
      Eigen::Index column = 0;
      groups[static_cast<std::size_t>(c)] =
          h.combine.row(c).maxCoeff(&column) > 0 ? static_cast<int>(column) : -1;
    }
    return std::make_shared<const AxisLaw>(name, shape, groups, h.names);
  };
  return out;
}

/// Five laws of an axis: two of temperature, one of time, two of the field.
inline std::vector<criticism::tests::CandidateEffect> few_candidates() {
  const auto warmer = [](const Pose& p, int i) { return *p.T_degC[static_cast<std::size_t>(i)] - 20; };
  return {
      candidate_effect("offset.temperature",
                       [warmer](const Pose& p, double, int i, double) { return warmer(p, i); }),
      candidate_effect("gain.temperature", [warmer](const Pose& p, double, int i,
                                                    double v) { return warmer(p, i) * v / 50'000; }),
      candidate_effect("offset.drift", [](const Pose&, double t_h, int, double) { return t_h; }),
      candidate_effect("quadratic",
                       [](const Pose&, double, int, double v) { return std::pow(v / 50'000, 2); }),
      candidate_effect("cubic", [](const Pose&, double, int, double v) { return std::pow(v / 50'000, 3); })};
}

}  // namespace mgtd::calib::testing
