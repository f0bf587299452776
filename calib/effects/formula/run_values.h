// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "calib/effects/effect_context.h"
#include "calib/effects/formula/formula_names.h"
#include "calib/poses/run_time.h"

/// RunValues gives the values that the names of a formula of the axes have at every pose of a run
/// (formula.h), in the order of the table; NaN where a pose has none. What a formula calls u, ux, uy, uz, the
/// field terms of the axes, is here reading less offset: the same to the noise of a reading.
namespace mgtd::calib::effects::formula {

class RunValues {
 public:
  /// Offsets as in run_memory.h where the context has none. The table must outlive this. Refuses a context
  /// without poses.
  [[nodiscard]] static Result<RunValues> of(const EffectContext& context);

  [[nodiscard]] const PoseTable& table() const { return *table_; }
  [[nodiscard]] const std::vector<double>& t_h() const { return t_h_; }
  [[nodiscard]] int sensors() const { return static_cast<int>(table_->poses.front().y_nT.size()); }
  [[nodiscard]] std::vector<double> of(const FormulaName& name, int sensor, int axis) const;
  [[nodiscard]] std::vector<double> of(const std::string& name, int sensor, int axis) const;

 private:
  RunValues(const PoseTable& table, std::vector<double> t_h, std::vector<PerSensor<Eigen::Vector3d>> v_nT)
      : table_(&table), t_h_(std::move(t_h)), v_nT_(std::move(v_nT)) {}

  const PoseTable* table_;
  std::vector<double> t_h_;
  std::vector<PerSensor<Eigen::Vector3d>> v_nT_;
};

}  // namespace mgtd::calib::effects::formula
