// SPDX-License-Identifier: Apache-2.0
// What the elimination of one pose costs: its 4 x 4 equations factored and solved.
#include <benchmark/benchmark.h>

#include <Eigen/Cholesky>

#include "calib/linear/cholesky4.h"

namespace mgtd::calib {
namespace {

Eigen::Matrix4d of_a_pose() {
  Eigen::Matrix4d H = Eigen::Matrix4d::Constant(1);
  H.diagonal() << 3e9, 2e9, 4e9, 2;
  return H;
}

template <class Factor>
void factor_and_solve(benchmark::State& state) {
  Eigen::Matrix4d H = of_a_pose();
  Eigen::Vector4d b{1e4, -2e4, 3e3, 1};
  for (auto _ : state) {
    benchmark::DoNotOptimize(H);
    benchmark::DoNotOptimize(b);
    const Eigen::Vector4d x = Factor(H).solve(b);
    benchmark::DoNotOptimize(x);
  }
}
BENCHMARK(factor_and_solve<linear::Cholesky4>);
BENCHMARK(factor_and_solve<Eigen::LLT<Eigen::Matrix4d>>);

}  // namespace
}  // namespace mgtd::calib
