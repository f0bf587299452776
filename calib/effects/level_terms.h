// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>

#include "calib/effects/effect.h"

/// LevelTerms sums the terms of all effects of one level, with their derivatives.
namespace mgtd::calib::effects {

inline constexpr int kMaxTermInputs = 6, kMaxTermOutputs = 5;
using TermValue = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxTermOutputs, 1>;

struct TermSum {
  TermValue value;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxTermOutputs, kMaxTermInputs> d_input;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxTermOutputs>
      d_coefficient;  ///< one column per coefficient of the model
};

/// Effects of a model by level. An effect that a pose cannot feed (Effect::missing) adds nothing there.
/// Coefficients of all effects stand in one vector, in the order of the effects.
class LevelTerms {
 public:
  LevelTerms(const std::vector<EffectPtr>& effects, Level level);
  [[nodiscard]] bool empty() const { return entries_.empty(); }
  [[nodiscard]] TermSum sum(const Conditions& at, int sensor, std::span<const double> in,
                            const Eigen::VectorXd& coefficients) const;
  /// The same into `total`, whose storage is used again.
  void sum(const Conditions& at, int sensor, std::span<const double> in, const Eigen::VectorXd& coefficients,
           TermSum& total) const;
  /// The value alone, `outputs_of(level)` numbers.
  [[nodiscard]] TermValue value(const Conditions& at, int sensor, std::span<const double> in,
                                const Eigen::VectorXd& coefficients) const;
  /// Effect::sd_nT_per_rad of all together.
  [[nodiscard]] double sd_nT_per_rad(const Conditions& at, int sensor, int axis,
                                     const Eigen::VectorXd& coefficients) const;

 private:
  struct Entry {
    const Effect* effect;
    int first;  ///< of its coefficients in the vector of all
  };
  /// Where all coefficients are zero a linear term has derivatives by them and nothing else; false elsewhere,
  /// and where the term is not linear.
  [[nodiscard]] static bool add_at_zero(const Entry& entry, const Conditions& at, int sensor,
                                        std::span<const double> in, std::span<const int> active,
                                        const Eigen::VectorXd& coefficients, TermSum& total);

  Level level_;
  std::vector<Entry> entries_;
};

}  // namespace mgtd::calib::effects
