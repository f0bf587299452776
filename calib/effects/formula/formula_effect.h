// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "calib/effects/effect_spec.h"
#include "calib/effects/formula/expression.h"
#include "calib/effects/formula/formula_names.h"
#include "calib/effects/formula/history_name.h"
#include "calib/effects/laws/axis_scale.h"

/// A FormulaEffect is a user's formula (formula.h) as a term of the model. The derivative by a coefficient is
/// exact (the term with that coefficient one and the others zero); those by the field and the place are
/// central differences at two steps, extrapolated to none.
namespace mgtd::calib::effects::formula {

inline constexpr std::size_t kFormulaNames = 24;
/// Of a formula that a gradient is multiplied by: with five components each a term holds no more.
inline constexpr std::size_t kGradientCoefficients = kMaxActive / 5;

class FormulaEffect final : public Effect {
 public:
  /// `gradient`: at the site, of a gradient instead of a vector.
  FormulaEffect(EffectSpec spec, Level level, bool gradient, Expression expression,
                std::vector<FormulaName> names, const std::string& unit, double prior_sd);

  [[nodiscard]] std::string_view name() const override { return spec_.name; }
  [[nodiscard]] std::string spec() const override { return spec_.text(); }
  [[nodiscard]] Level level() const override { return level_; }
  [[nodiscard]] const std::vector<Coefficient>& coefficients() const override { return coefficients_; }
  [[nodiscard]] std::span<const int> at(int sensor) const override {
    return level_ == Level::site ? std::span<const int>(site_) : scale_.at(sensor);
  }
  /// With the values of the names that look back over the run; null where it has none.
  [[nodiscard]] Result<std::shared_ptr<const Effect>> bound(const EffectContext& context) const override;
  [[nodiscard]] std::string_view missing(const Pose& pose) const override;
  /// Also refuses poses at which the formula has no value.
  [[nodiscard]] Result<void> applicable(const PoseTable& table) const override;
  void term(const Conditions& at, int sensor, std::span<const double> in, std::span<const double> c,
            std::span<double> out) const override;
  void term(const Conditions& at, int sensor, std::span<const Jet> in, std::span<const Jet> c,
            std::span<Jet> out) const override;

  [[nodiscard]] const std::vector<FormulaName>& names() const { return names_; }

 private:
  using Values = std::array<double, kFormulaNames>;
  using Inputs = std::array<double, 6>;
  using Own = std::array<double, 3>;  ///< coefficients of one axis, or of one component of the gradient
  /// By number of a pose: a value for each name that looks back, sensor and axis, in this order.
  using Before = std::unordered_map<int, std::vector<double>>;

  void add_of_site(const std::string& unit, double typical);
  template <class S>
  void gradient_term(const Conditions& at, int sensor, std::span<const S> x, std::span<const S> c,
                     std::span<S> out) const;
  [[nodiscard]] std::size_t place_before(std::size_t looking_back, int sensor, int axis) const;
  [[nodiscard]] int first(int sensor, int axis) const;
  void set_conditions(const Conditions& at, int sensor, Values& values) const;
  void set_inputs(const Inputs& in, int axis, Values& values) const;
  /// What was before the pose; false where it has nothing before it, and the term is zero.
  [[nodiscard]] bool set_before(const Conditions& at, int sensor, int axis, Values& values) const;
  [[nodiscard]] double value(Values& values, const Own& c) const;
  [[nodiscard]] double slope(Values& values, const Inputs& in, int axis, std::size_t input,
                             const Own& c) const;

  EffectSpec spec_;
  Level level_;
  bool gradient_;
  Expression expression_;
  std::vector<FormulaName> names_;
  std::size_t per_axis_{1};
  bool implicit_{true};              ///< no coefficient in the text: the whole is multiplied by one
  std::vector<std::size_t> inputs_;  ///< that it uses
  struct LookingBack {
    std::size_t name;  ///< of names_
    HistoryName::Kind kind;
  };
  std::vector<LookingBack> looking_back_;
  std::shared_ptr<const Before> before_;
  bool uses_own_{false};
  laws::AxisScale scale_;
  std::vector<Coefficient> coefficients_;
  std::vector<int> site_;
};

}  // namespace mgtd::calib::effects::formula
