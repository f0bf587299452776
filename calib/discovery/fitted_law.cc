// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/fitted_law.h"

#include <algorithm>
#include <cmath>

namespace mgtd::calib::discovery {
namespace {

/// Values of the columns on each channel; those of the gradient are alike.
Result<std::vector<Eigen::MatrixXd>> values_on(const Columns& columns, const std::vector<int>& on,
                                               LawInputs& inputs) {
  std::vector<Eigen::MatrixXd> out;
  for (const int c : on) {
    Eigen::MatrixXd values = Eigen::MatrixXd::Zero(inputs.poses(), static_cast<Eigen::Index>(columns.size()));
    for (std::size_t j = 0; j < columns.size(); ++j) {
      const auto column = inputs(columns[j], c < inputs.channels() ? c : 0);
      if (!column) return tl::unexpected(column.error());
      if (column->size() > 0) values.col(static_cast<Eigen::Index>(j)) = *column;
    }
    out.push_back(std::move(values));
  }
  return out;
}

LawOnChannels on_channels(const std::vector<Eigen::MatrixXd>& values, const std::vector<int>& on, int total,
                          const Eigen::VectorXd& coefficients) {
  LawOnChannels out(static_cast<std::size_t>(total));
  for (std::size_t a = 0; a < on.size(); ++a) {
    const Eigen::Index count = values[a].cols();
    out[static_cast<std::size_t>(on[a])] =
        values[a] * coefficients.segment(static_cast<Eigen::Index>(a) * count, count);
  }
  return out;
}

}  // namespace

Result<LawOnChannels> law_on(const Columns& columns, const Place& place, const Eigen::VectorXd& value,
                             LawInputs& inputs, int channels, int total) {
  const std::vector<int> on = place.channels(channels);
  const auto values = values_on(columns, on, inputs);
  if (!values) return tl::unexpected(values.error());
  return on_channels(*values, on, total, value);
}

double FittedLaw::d() const { return std::sqrt(std::max(0.0, S - k)); }

Result<FittedLaw> fitted_law(const Columns& columns, const Place& place, LawInputs& inputs,
                             const ChannelSums& sums) {
  FittedLaw out;
  out.columns = columns;
  out.place = place;
  const std::vector<int> on = place.channels(sums.channels());
  const auto values = values_on(columns, on, inputs);
  if (!values) return tl::unexpected(values.error());
  const auto count = static_cast<Eigen::Index>(columns.size());
  const Eigen::Index n = count * static_cast<Eigen::Index>(on.size());
  const Eigen::MatrixXd B = sums.before_projection(on, *values);
  Eigen::VectorXd v(n), length2 = B.diagonal();
  Eigen::MatrixXd taken_up;
  for (std::size_t a = 0; a < on.size(); ++a) {
    const auto at = static_cast<Eigen::Index>(a) * count;
    v.segment(at, count) = (*values)[a].transpose() * sums.score(on[a]);
    const Eigen::MatrixXd of_channel = sums.taken_up(on[a], (*values)[a]);
    taken_up.conservativeResize(of_channel.rows(), n);
    taken_up.middleCols(at, count) = of_channel;
    const Eigen::VectorXd& of_one = sums.before_of_one(on[a]);
    length2.segment(at, count) -= ((*values)[a].transpose() * of_one).cwiseAbs2() / of_one.sum();
  }
  const Eigen::MatrixXd A = B - taken_up.transpose() * taken_up;
  const Eigen::VectorXd scale =
      one_over_length_left(A.diagonal(), length2, B.diagonal(), sums.absorbed_share());
  const Eigen::MatrixXd V =
      scale.asDiagonal() * combinations(scale.asDiagonal() * A * scale.asDiagonal(),
                                        scale.asDiagonal() * B * scale.asDiagonal(), sums.absorbed_share());
  const Eigen::VectorXd along = V.transpose() * v;
  out.k = static_cast<int>(V.cols());
  out.S = along.squaredNorm();
  out.value = V * along;
  out.covariance = V * V.transpose();
  out.law = on_channels(*values, on, sums.total(), out.value);
  for (Eigen::Index j = 0; j < V.cols(); ++j)
    out.basis.push_back(on_channels(*values, on, sums.total(), V.col(j)));
  return out;
}

void take_out(const FittedLaw& law, ChannelSums& sums) {
  for (const LawOnChannels& direction : law.basis) sums.take_out(direction);
}

double beyond(const FittedLaw& a, const FittedLaw& b, const ChannelSums& sums) {
  const std::vector<Eigen::VectorXd> signature = sums.by_channel(a.law);
  double out = 0;
  for (std::size_t c = 0; c < a.law.size(); ++c)
    if (a.law[c].size() > 0) out += a.law[c].dot(signature[c]);
  for (const LawOnChannels& direction : b.basis) {
    double along = 0;
    for (std::size_t c = 0; c < direction.size(); ++c)
      if (direction[c].size() > 0) along += direction[c].dot(signature[c]);
    out -= along * along;
  }
  return std::max(0.0, out);
}

}  // namespace mgtd::calib::discovery
