// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/law_inputs.h"

#include <cmath>
#include <unordered_map>

#include "calib/effects/formula/history_name.h"
#include "calib/fit/joint/pose_model.h"

namespace mgtd::calib::discovery {
namespace {

using effects::formula::FormulaName;
using Source = FormulaName::Source;

/// Readings that the fit predicts, less offset: poses x channels. What is measured has the noise of a reading
/// in it, and of a noisy sensor without angles a gain that shrinks everything would take the residual with
/// it.
Eigen::MatrixXd field_terms(const fit::joint::JointFit& fit) {
  const auto poses = static_cast<Eigen::Index>(fit.problem.poses.size());
  Eigen::MatrixXd out(poses, fit.problem.channels());
  const fit::joint::PoseModel model(fit.problem, fit.state);
  fit::joint::PoseLinear linear;
  for (Eigen::Index k = 0; k < poses; ++k) {
    const auto at = static_cast<std::size_t>(k);
    model.linearise(fit.problem.poses[at], fit.state.nuisances[at], linear);
    out.row(k) = linear.y_nT.transpose();
  }
  for (Eigen::Index c = 0; c < out.cols(); ++c)
    out.col(c).array() -= fit.state.sensors[static_cast<std::size_t>(c / 3)].offset_nT[c % 3];
  return out;
}

bool of_the_field(const FormulaName& name) {
  if (name.source == Source::history)
    return of_the_field(effects::formula::formula_name(effects::formula::history_name(name.name)->of,
                                                       effects::Level::axis, std::nullopt, 0));
  return name.source == Source::own || name.source == Source::input || name.name.ends_with("_nT") ||
         name.name.ends_with("_deg") || name.name == "pose" || name.name == "sense" || name.name == "mount";
}

}  // namespace

Result<LawInputs> LawInputs::of(const fit::joint::JointFit& fit, const PoseTable& run) {
  PerSensor<Eigen::Vector3d> offset_nT(fit.state.sensors.size());
  for (std::size_t i = 0; i < offset_nT.size(); ++i) offset_nT[i] = fit.state.sensors[i].offset_nT;
  const effects::EffectContext context{.table = &run, .offset_nT = offset_nT};
  auto values = effects::formula::RunValues::of(context);
  if (!values) return tl::unexpected(values.error());
  std::unordered_map<int, std::size_t> by_number;
  for (std::size_t k = 0; k < run.poses.size(); ++k) by_number.emplace(run.poses[k].number, k);
  std::vector<std::size_t> rows;
  for (const fit::joint::JointPose& pose : fit.problem.poses) {
    const auto found = by_number.find(pose.pose->number);
    if (found == by_number.end()) return fail(ErrorCode::internal, "a pose of the fit is not in its table");
    rows.push_back(found->second);
  }
  return LawInputs(Data{.values = *std::move(values), .rows = std::move(rows), .field_nT = field_terms(fit)});
}

Eigen::VectorXd LawInputs::Data::name(const std::string& text, int channel) const {
  const FormulaName name = effects::formula::formula_name(text, effects::Level::axis, std::nullopt, 0);
  if (name.source == Source::own) return field_nT.col(channel);
  if (name.source == Source::input)
    return field_nT.col(channel - channel % 3 + static_cast<Eigen::Index>(name.index));
  const std::vector<double> all = values.of(name, channel / 3, channel % 3);
  Eigen::VectorXd out(static_cast<Eigen::Index>(rows.size()));
  double sum = 0, count = 0;
  for (Eigen::Index k = 0; k < out.size(); ++k) {
    out[k] = all[rows[static_cast<std::size_t>(k)]];
    if (std::isfinite(out[k])) sum += out[k], ++count;
  }
  if (stretch != 1 && count > 0 && !of_the_field(name))
    out = (sum / count + stretch * (out.array() - sum / count)).matrix();
  if (text == turned) out.array() += by_deg;
  return out;
}

void LawInputs::begin_tables() {
  tables_.clear();
  for (int c = 0; c < channels(); ++c)
    tables_.emplace_back(poses(), [data = data_.get(), c](const std::string& asked) {
      return std::optional(data->name(asked, c));
    });
}

Result<Eigen::VectorXd> LawInputs::operator()(const std::string& expression, int channel) {
  auto out = tables_[static_cast<std::size_t>(channel)](expression);
  if (!out) return out;
  bool any = false;
  for (double& x : *out) {
    if (std::isfinite(x)) {
      any = true;
    } else {
      x = 0;
    }
  }
  if (!any) out->resize(0);
  return out;
}

}  // namespace mgtd::calib::discovery
