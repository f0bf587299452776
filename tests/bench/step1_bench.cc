// SPDX-License-Identifier: Apache-2.0
// Scalar calibration of one sensor. 5832 poses: the fastest peer measured takes 0.14 ms (normal equations on
// scaled data), the classic C implementation 0.27 ms.
#include <benchmark/benchmark.h>

#include "calib/sensor/step1.h"
#include "tests/support/paper_rigs.h"

namespace mgtd::calib {
namespace {

struct Data {
  Eigen::Matrix3Xd y_nT;
  Eigen::VectorXd f_nT;
};

Data one_sensor(const std::vector<testing::AttitudeDeg>& attitudes) {
  const PoseTable table = testing::measure(testing::table3_rig(), {50'000, 60, -5}, attitudes, 18,
                                           {testing::Noise::Kind::uniform, 1.0, 0.0}, 3);
  const auto n = static_cast<Eigen::Index>(table.poses.size());
  Data out{Eigen::Matrix3Xd(3, n), Eigen::VectorXd::Constant(n, 50'000)};
  for (Eigen::Index k = 0; k < n; ++k) out.y_nT.col(k) = table.poses[static_cast<std::size_t>(k)].y_nT[0];
  return out;
}

void step1(benchmark::State& state) {
  const Data data = one_sensor(state.range(0) == 5832 ? testing::grid_5832() : testing::standard_run(121, 1));
  for (auto _ : state) {
    auto fitted = sensor::scalar_calibration(data.y_nT, data.f_nT);
    if (!fitted) return state.SkipWithError(fitted.error().text().c_str());
    benchmark::DoNotOptimize(fitted->K);
  }
  state.counters["condition"] = sensor::scalar_calibration(data.y_nT, data.f_nT)->condition;
}
BENCHMARK(step1)->ArgName("poses")->Arg(157)->Arg(5832)->Unit(benchmark::kMicrosecond);

/// A scalar reference that moves: the field differs from pose to pose.
void step1_field_per_pose(benchmark::State& state) {
  Data data = one_sensor(testing::grid_5832());
  for (Eigen::Index k = 0; k < data.f_nT.size(); ++k)
    data.f_nT[k] += 10 * std::sin(0.01 * static_cast<double>(k));
  for (auto _ : state) {
    auto fitted = sensor::scalar_calibration(data.y_nT, data.f_nT);
    if (!fitted) return state.SkipWithError(fitted.error().text().c_str());
    benchmark::DoNotOptimize(fitted->K);
  }
}
BENCHMARK(step1_field_per_pose)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace mgtd::calib
