// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/argument_noise.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "proto/units.h"

namespace mgtd::calib::discovery {

Result<Eigen::MatrixXd> variance_of_angles(const FittedLaw& law, double sd_rad, LawInputs& inputs) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(inputs.poses(), inputs.channels());
  if (!(sd_rad > 0)) return out;
  const auto at = [&](const std::string& angle, double by_deg) {
    inputs.turn(angle, by_deg);
    auto values = law_on(law.columns, law.place, law.value, inputs, inputs.channels(),
                         static_cast<int>(law.law.size()));
    inputs.turn(angle, 0);
    return values;
  };
  for (const std::string angle : {"azimuth_deg", "pitch_deg", "roll_deg"}) {
    const auto of_angle = [&](const std::string& column) { return column.find(angle) != std::string::npos; };
    if (std::none_of(law.columns.begin(), law.columns.end(), of_angle)) continue;
    const auto more = at(angle, to_deg(sd_rad)), less = at(angle, -to_deg(sd_rad));
    if (!more) return tl::unexpected(more.error());
    if (!less) return tl::unexpected(less.error());
    for (Eigen::Index c = 0; c < out.cols(); ++c) {
      const auto channel = static_cast<std::size_t>(c);
      if ((*more)[channel].size() > 0) out.col(c) += (((*more)[channel] - (*less)[channel]) / 2).cwiseAbs2();
    }
  }
  return out;
}

fit::joint::JointFit beside_variance(fit::joint::JointFit fit, const Eigen::MatrixXd& variance_nT2) {
  for (std::size_t k = 0; k < fit.problem.poses.size(); ++k) {
    auto& weight = fit.problem.poses[k].weight;
    const Eigen::VectorXd more = variance_nT2.row(static_cast<Eigen::Index>(k)).transpose();
    weight = (weight.array().square().inverse() + more.array()).rsqrt().matrix();
  }
  fit::joint::refit_nuisances(fit.problem, fit.state);
  return fit;
}

}  // namespace mgtd::calib::discovery
