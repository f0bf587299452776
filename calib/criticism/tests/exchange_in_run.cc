// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/exchange_in_run.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "calib/criticism/tests/possible_exchanges.h"

namespace mgtd::calib::criticism::tests {
namespace {

constexpr std::size_t kFewest = 3, kFewestInAll = 24;  // poses on either side; nine numbers from all
constexpr double kExchangeBetter = 5, kOtherExchange = 2, kLeast_nT = 5;
constexpr int kNumbers = 9;
using Row = Eigen::Matrix<double, kNumbers, 1>;

/// Sums of a linear least-squares problem; they add and subtract.
struct Normal {
  Eigen::Matrix<double, kNumbers, kNumbers> A{Eigen::Matrix<double, kNumbers, kNumbers>::Zero()};
  Row b{Row::Zero()};
  double c{0};
  void add(const Row& x, double y) {
    A += x * x.transpose();
    b += y * x;
    c += y * y;
  }
  [[nodiscard]] Normal with(const Normal& all, const Normal& before) const {
    Normal out = *this;
    out.A += all.A - before.A;
    out.b += all.b - before.b;
    out.c += all.c - before.c;
    return out;
  }
  /// What is left of the squares.
  [[nodiscard]] double misfit() const { return std::max(0.0, c - b.dot(A.ldlt().solve(b))); }
};

double mean_field_nT(const PoseTable& table, std::optional<double> field_nT) {
  double sum = 0, n = 0;
  for (const Pose& pose : table.poses) {
    if (!pose.f_nT) continue;
    sum += *pose.f_nT;
    ++n;
  }
  if (n > 0) return sum / n;
  if (field_nT) return *field_nT;
  for (const Pose& pose : table.poses) sum += pose.y_nT[0].norm() / static_cast<double>(table.poses.size());
  return sum;
}

Row row_of(const Eigen::Vector3d& y) {
  Row x;
  x << y[0] * y[0], y[1] * y[1], y[2] * y[2], y[0] * y[1], y[0] * y[2], y[1] * y[2], y;
  return x;
}

/// Sums up to before each pose, sensor by sensor; those of all poses at the end.
using Sums = PerSensor<std::vector<Normal>>;

Sums sums_of(const PoseTable& table, double f_nT) {
  Sums out(table.poses.front().y_nT.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    Normal sum;
    for (const Pose& pose : table.poses) {
      out[i].push_back(sum);
      const double f = pose.f_nT.value_or(f_nT) / f_nT;
      sum.add(row_of(pose.y_nT[i] / f_nT), f * f);
    }
    out[i].push_back(sum);
  }
  return out;
}

struct Best {
  double misfit{std::numeric_limits<double>::max()};
  PerSensor<std::size_t> sensor{};
  std::size_t from{0};
};

/// The best of every exchange at one pose, into `best` by exchange.
void look_at(const Sums& sums, std::size_t from, const std::vector<PerSensor<std::size_t>>& exchanges,
             std::vector<Best>& best) {
  const std::size_t sensors = sums.size();
  PerSensor<PerSensor<double>> misfit(sensors, PerSensor<double>(sensors));
  for (std::size_t i = 0; i < sensors; ++i) {
    for (std::size_t j = 0; j < sensors; ++j)
      misfit[i][j] = sums[i][from].with(sums[j].back(), sums[j][from]).misfit();
  }
  for (std::size_t number = 0; number < exchanges.size(); ++number) {
    // What comes in a place from here on belongs to the sensor whose it is.
    const PerSensor<std::size_t>& sensor = exchanges[number];
    double sum = 0;
    for (std::size_t place = 0; place < sensors; ++place) sum += misfit[sensor[place]][place];
    if (sum < best[number].misfit) best[number] = {sum, sensor, from};
  }
}

}  // namespace

std::optional<ExchangeInRun> exchange_in_run(const PoseTable& table, std::optional<double> field_nT) {
  const std::size_t n = table.poses.size();
  if (n < kFewestInAll) return std::nullopt;
  const auto exchanges = possible_exchanges(table.poses.front().y_nT.size());
  if (exchanges.empty()) return std::nullopt;
  const double f_nT = mean_field_nT(table, field_nT);
  const Sums sums = sums_of(table, f_nT);
  double without = 0;
  for (const auto& of_sensor : sums) without += of_sensor.back().misfit();
  std::vector<Best> best(exchanges.size());
  for (std::size_t from = kFewest; from + kFewest <= n; ++from) look_at(sums, from, exchanges, best);
  std::sort(best.begin(), best.end(), [](const Best& a, const Best& b) { return a.misfit < b.misfit; });
  const auto to_nT = [&](double misfit) {
    return std::sqrt(misfit / static_cast<double>(sums.size() * n)) * f_nT / 2;
  };
  const double taken_so = to_nT(best[0].misfit), as_it_stands = to_nT(without);
  if (as_it_stands < kLeast_nT || as_it_stands < kExchangeBetter * taken_so ||
      (best.size() > 1 && to_nT(best[1].misfit) < kOtherExchange * taken_so))
    return std::nullopt;
  ExchangeInRun out;
  out.what.sensor = best[0].sensor;
  out.from_pose = table.poses[best[0].from].number;
  out.residual_nT = taken_so;
  out.without_nT = as_it_stands;
  return out;
}

std::optional<Rearrangement> exchanged_since(const calibration::Calibration& before,
                                             const calibration::Calibration& now) {
  constexpr double kAged_nT = 10, kAged = 2e-4, kOwn = 10;
  const auto apart = [&](std::size_t i, std::size_t j) {
    const sensor::SensorModel &a = now.sensors[i], &b = before.sensors[j];
    const Eigen::Vector3d skew(a.theta_rad - b.theta_rad, a.phi_rad - b.phi_rad, a.psi_rad - b.psi_rad);
    const double square = (skew / kAged).squaredNorm() + ((a.scale - b.scale) / kAged).squaredNorm() +
                          ((a.offset_nT - b.offset_nT) / kAged_nT).squaredNorm();
    return std::sqrt(square / kNumbers);
  };
  for (const PerSensor<std::size_t>& sensor : possible_exchanges(now.sensors.size())) {
    bool fits = true;
    for (std::size_t place = 0; place < sensor.size() && fits; ++place) {
      const std::size_t whose = sensor.at(place);
      fits = apart(place, whose) < 1 && (whose == place || apart(place, place) > kOwn);
    }
    if (fits) return Rearrangement{.sensor = sensor};
  }
  return std::nullopt;
}

}  // namespace mgtd::calib::criticism::tests
