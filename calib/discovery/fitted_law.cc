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
  Eigen::MatrixXd A(n, n), B(n, n);
  Eigen::VectorXd v(n), length2(n), whole(n);
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(sums.poses());
  std::vector<Eigen::MatrixXd> taken_up;
  for (std::size_t a = 0; a < on.size(); ++a) {
    const auto at = static_cast<Eigen::Index>(a) * count;
    v.segment(at, count) = (*values)[a].transpose() * sums.score(on[a]);
    taken_up.push_back(sums.taken_up(on[a], (*values)[a]));
    for (std::size_t b = 0; b <= a; ++b) {
      const auto beside = static_cast<Eigen::Index>(b) * count;
      const Eigen::MatrixXd before = sums.before_projection(on[b], on[a], (*values)[a]);
      B.block(beside, at, count, count) = (*values)[b].transpose() * before;
      A.block(beside, at, count, count) =
          B.block(beside, at, count, count) - taken_up[b].transpose() * taken_up[a];
      if (b < a) continue;
      const double of_one = one.dot(sums.before_projection(on[a], on[a], one).col(0));
      whole.segment(at, count) = B.diagonal().segment(at, count);
      length2.segment(at, count) =
          whole.segment(at, count) - (one.transpose() * before).transpose().cwiseAbs2() / of_one;
    }
  }
  A.triangularView<Eigen::StrictlyLower>() = A.transpose();
  B.triangularView<Eigen::StrictlyLower>() = B.transpose();
  const Eigen::VectorXd scale = length_left(A.diagonal(), length2, whole, sums.absorbed_share());
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
  double out = sums.product(a.law, a.law);
  for (const LawOnChannels& direction : b.basis) {
    double along = 0;
    for (std::size_t c = 0; c < direction.size(); ++c)
      if (direction[c].size() > 0) along += direction[c].dot(signature[c]);
    out -= along * along;
  }
  return std::max(0.0, out);
}

}  // namespace mgtd::calib::discovery
