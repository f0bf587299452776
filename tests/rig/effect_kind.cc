// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/effect_kind.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "tests/rig/scenario.h"

namespace mgtd::rig {
namespace {

/// An effect of the present: the functions of its kind with its own numbers.
class Law final : public EffectOf<Law> {
 public:
  Law(const EffectKind& kind, Where where, Numbers numbers, std::string covariate)
      : kind_(&kind), where_(std::move(where)), numbers_(std::move(numbers)), of_(std::move(covariate)) {}

  void begin(const Scenario& scenario) override {
    for (const Covariate& c : scenario.covariates)
      if (c.name == of_) covariate_ = c;
  }
  [[nodiscard]] std::string covariate() const override { return of_; }
  [[nodiscard]] double axis_nT(const AxisContext& c) const override {
    return kind_->axis != nullptr && where_.covers(c) ? kind_->axis(c, at(c.t_s)) : 0;
  }
  [[nodiscard]] Eigen::Vector3d site_nT(double t_s, const Eigen::Vector3d& x_m) const override {
    return kind_->site == nullptr ? Eigen::Vector3d(0, 0, 0) : kind_->site(t_s, x_m, at(t_s));
  }
  [[nodiscard]] Eigen::Vector3d platform_nT(const PlatformContext& c) const override {
    return kind_->platform != nullptr && where_.covers_sensor(c.sensor) ? kind_->platform(c, at(c.t_s))
                                                                        : Eigen::Vector3d(0, 0, 0);
  }
  [[nodiscard]] Eigen::Vector3d turn_rad(const PlatformContext& c) const override {
    return kind_->turn_rad != nullptr && where_.covers_sensor(c.sensor) ? kind_->turn_rad(c, at(c.t_s))
                                                                        : Eigen::Vector3d(0, 0, 0);
  }
  [[nodiscard]] TableError table(const TableContext& c) const override {
    return kind_->table == nullptr ? TableError{} : kind_->table(c, numbers_);
  }
  [[nodiscard]] double reference_nT(const Eigen::Vector3d& u) const override {
    return kind_->reference == nullptr ? 0 : kind_->reference(u, numbers_);
  }
  [[nodiscard]] nlohmann::json truth() const override;

 private:
  [[nodiscard]] const Numbers& at(double t_s) const {
    if (!of_.empty()) numbers_.covariate = covariate_.at(t_s);
    return numbers_;
  }

  const EffectKind* kind_;
  Where where_;
  mutable Numbers numbers_;  ///< the covariate's value changes with time
  std::string of_;
  Covariate covariate_;
};

nlohmann::json Law::truth() const {
  nlohmann::json out{{"effect", kind_->name}};
  if (kind_->scope != Scope::none) out["where"] = where_.text();
  if (!of_.empty()) out["of"] = of_;
  std::size_t next = 0;
  for (const Key& key : kind_->keys) {
    if (key.name == nullptr) break;
    nlohmann::json& values = out[key.name];
    if (key.count == 1) {
      values = numbers_[next++];
      continue;
    }
    for (int i = 0; i < key.count; ++i) values.push_back(numbers_[next++]);
  }
  return out;
}

}  // namespace

std::vector<const EffectKind*> all_kinds() {
  std::vector<const EffectKind*> out;
  for (const auto& list : {axis_kinds(), platform_kinds(), table_kinds(), site_kinds(), unnamed_kinds()})
    for (const EffectKind& kind : list) out.push_back(&kind);
  return out;
}

std::unique_ptr<Effect> make_effect(const EffectKind& kind, const Where& where, Numbers numbers,
                                    const std::string& covariate) {
  if (kind.build != nullptr) return kind.build(kind, where, numbers);
  return std::make_unique<Law>(kind, where, std::move(numbers), covariate);
}

}  // namespace mgtd::rig
