// SPDX-License-Identifier: Apache-2.0
#include "tests/blind/blind.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "calib/criticism/residual.h"

namespace mgtd::calib::testing {
namespace {

void count(const ExplainReport& r, const std::string& truth, Answers& out) {
  ++out.runs;
  ++out.findings[r.finding];
  if (r.finding == Finding::pass) return;
  ++out.detected;
  if (r.named.empty()) return;
  ++out.first[r.named.front()];
  std::vector<std::string> set = r.named;
  for (const Round& round : r.rounds) set.insert(set.end(), round.possible.begin(), round.possible.end());
  std::sort(set.begin(), set.end());
  set.erase(std::unique(set.begin(), set.end()), set.end());
  out.set_size += static_cast<int>(set.size());
  if (r.named.front() == truth) ++out.named_first;
  if (std::find(set.begin(), set.end(), truth) != set.end()) ++out.in_set;
  if (r.finding == Finding::explained && r.named.front() != truth) ++out.wrong_single;
}

void ask(const PoseTable& table, const std::string& truth, Answers& out) {
  const auto report = explain(table, {});
  if (!report) {
    ++out.runs, ++out.refused;
    return;
  }
  count(*report, truth, out);
}

}  // namespace

Answers clean(const HiddenRun& run, int runs, std::uint64_t seed) {
  Answers out;
  for (int i = 0; i < runs; ++i) ask(hidden_run(run, seed + static_cast<std::uint64_t>(i)), "", out);
  return out;
}

double crb_of(const HiddenLaw& law, int sensor, int axis, std::uint64_t seed) {
  const PoseTable table = hidden_run({}, seed);
  const auto fit = fit_joint(table, {});
  if (!fit) throw std::runtime_error(fit.error().text());
  const Residual residual(fit->problem, fit->state, 0);
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(residual.poses() * kPoseRows, 1);
  for (Eigen::Index k = 0; k < residual.poses(); ++k) {
    const JointPose& pose = fit->problem.poses[static_cast<std::size_t>(k)];
    const Eigen::Vector3d v =
        pose.y_nT.segment<3>(3 * sensor) - fit->state.sensors[static_cast<std::size_t>(sensor)].offset_nT;
    const int c = 3 * sensor + axis;
    rows(k * kPoseRows + c, 0) = pose.weight[c] * law.law(*pose.pose, sensor, axis, v);
  }
  return 1 / residual.project(rows).projected.norm();
}

Answers hidden(const HiddenLaw& law, double d, int runs, std::uint64_t seed) {
  Answers out;
  for (int i = 0; i < runs; ++i) {
    const std::uint64_t s = seed + static_cast<std::uint64_t>(i);
    const int c = i % kChannels;
    const double size = (i % 2 == 0 ? d : -d) * crb_of(law, c / 3, c % 3, s);
    ask(hidden_run({.hidden = hide(law, c / 3, c % 3, size)}, s), std::string(law.name), out);
  }
  return out;
}

Proportion proportion(int hits, int of) {
  if (of == 0) return {};
  constexpr double z = 1.96;
  const double n = of, p = hits / n, scale = 1 / (1 + z * z / n);
  const double middle = scale * (p + z * z / (2 * n));
  const double half = scale * z * std::sqrt(p * (1 - p) / n + z * z / (4 * n * n));
  return {100 * p, 100 * std::max(0.0, middle - half), 100 * std::min(1.0, middle + half)};
}

}  // namespace mgtd::calib::testing
