// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "calib/effects/formula/run_values.h"
#include "calib/effects/formula/tabulated_expression.h"
#include "calib/fit/joint/joint_fit.h"

/// LawInputs gives the quantities that laws may be functions of, at the poses of a fit. An expression has the
/// names of a formula of the axes (effects/formula/formula.h), and each channel reads its own: T_degC is the
/// temperature of its sensor, u the field along its axis.
namespace mgtd::calib::discovery {

class LawInputs {
 public:
  /// `run`: the table that was fitted, poses of the set "check" too; what looks back over the run needs
  /// those. Offsets are those of the fit. The table must outlive this.
  [[nodiscard]] static Result<LawInputs> of(const fit::joint::JointFit& fit, const PoseTable& run);

  [[nodiscard]] LawInputs copy() const { return LawInputs(*data_); }

  [[nodiscard]] Eigen::Index poses() const { return static_cast<Eigen::Index>(data_->rows.size()); }
  [[nodiscard]] int channels() const { return 3 * data_->values.sensors(); }
  [[nodiscard]] const PoseTable& run() const { return data_->values.table(); }

  /// Values of a name on a channel; NaN where a pose has none.
  [[nodiscard]] Eigen::VectorXd name(const std::string& name, int channel) const {
    return data_->name(name, channel);
  }
  /// Values of an expression on a channel, zero where it has none; empty where it has none anywhere. Refuses
  /// what is no expression. Several threads may ask, each of channels of its own.
  [[nodiscard]] Result<Eigen::VectorXd> operator()(const std::string& expression, int channel);

  /// Every number as far again from its mean over the run as `factor` says, but for angles and readings: to
  /// see what formulas say of conditions that did not occur.
  void stretch(double factor) { data_->stretch = factor, begin_tables(); }
  /// An angle ("azimuth_deg") as if the table stood elsewhere by so much; zero: as it was recorded.
  void turn(std::string angle, double by_deg) {
    data_->turned = std::move(angle), data_->by_deg = by_deg, begin_tables();
  }

 private:
  struct Data {
    effects::formula::RunValues values;
    std::vector<std::size_t> rows;  ///< in the table, of the poses that were fitted
    Eigen::MatrixXd field_nT;       ///< what a formula calls u, ux, uy, uz, as fitted
    double stretch{1};
    std::string turned{};  ///< an angle
    double by_deg{0};
    [[nodiscard]] Eigen::VectorXd name(const std::string& name, int channel) const;
  };
  explicit LawInputs(Data data) : data_(std::make_unique<Data>(std::move(data))) { begin_tables(); }
  void begin_tables();

  std::unique_ptr<Data> data_;
  std::vector<effects::formula::TabulatedExpression> tables_;  ///< by channel
};

}  // namespace mgtd::calib::discovery
