// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/sample_correlation.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "calib/fit/joint/joint_solver.h"
#include "calib/linear/cholesky4.h"

namespace mgtd::calib::fit::joint {

SampleCorrelation sample_correlation(const JointProblem& problem, const JointState& state) {
  std::vector<std::size_t> order(problem.poses.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return problem.poses[a].t_h < problem.poses[b].t_h; });
  const PoseModel model(problem, state);
  PoseBlocks b;
  sensor::ChannelCovariance now, before;
  Channels e, e_before;
  double products = 0, traces = 0, squares = 0;
  for (const std::size_t k : order) {
    assemble(problem, model, state, k, Blocks::own, b);
    const linear::Cholesky4 H(b.H);
    now = -b.N * H.solve(sensor::ChannelColumns<kNuisances>(b.N.transpose()));
    now.diagonal().array() += (problem.poses[k].weight.array() > 0).cast<double>();
    e = b.residual;
    if (before.size() > 0) {
      const sensor::ChannelCovariance both = now * before;
      products += e.dot(e_before);
      traces += both.trace();
      squares += both.cwiseProduct(both.transpose()).sum();
    }
    before = now;
    e_before = e;
  }
  if (!(traces > 0)) return {};
  return {.r = std::clamp(products / traces, -kMostCorrelated, kMostCorrelated),
          .sd = std::sqrt(std::max(squares, 0.0)) / traces};
}

}  // namespace mgtd::calib::fit::joint
