// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/wiring.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "calib/sensor/sensor_equations.h"

namespace mgtd::daemon::run {
namespace {

using Eigen::Matrix3d;

constexpr std::size_t kAttitudes = 3;  // fewer say nothing of the table

const std::vector<Matrix3d>& signed_permutations() {
  static const std::vector<Matrix3d> kAll = [] {
    std::vector<Matrix3d> all;
    std::array<int, 3> p{0, 1, 2};
    do {
      for (int signs = 0; signs < 8; ++signs) {
        Matrix3d S = Matrix3d::Zero();
        for (int row = 0; row < 3; ++row)
          S(row, p[static_cast<std::size_t>(row)]) = (signs >> row) % 2 == 0 ? 1 : -1;
        all.push_back(S);
      }
    } while (std::next_permutation(p.begin(), p.end()));
    return all;
  }();
  return kAll;
}

/// Those whose misfit is within the tolerance of the best; none when even the best is no fit.
template <class Misfit>
std::vector<Matrix3d> fitting(Misfit&& misfit) {
  double best = std::numeric_limits<double>::max();
  for (const Matrix3d& S : signed_permutations()) best = std::min(best, misfit(S));
  std::vector<Matrix3d> out;
  if (best > Wiring::kForeign) return out;
  for (const Matrix3d& S : signed_permutations())
    if (misfit(S) <= best + Wiring::kTolerance) out.push_back(S);
  return out;
}

bool straight(const std::vector<Matrix3d>& ways) {
  return std::any_of(ways.begin(), ways.end(), [](const Matrix3d& S) { return S.isIdentity(); });
}

template <class Is>
bool all_of(const std::vector<Matrix3d>& ways, Is is) {
  return std::all_of(ways.begin(), ways.end(), is);
}

bool mirrored(const Matrix3d& S) { return S.determinant() < 0; }

std::string directions(const Matrix3d& S) {
  std::string out;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      if (S(row, column) != 0)
        out += fmt::format("{}{}{}", row > 0 ? ", " : "", S(row, column) < 0 ? "-" : "+", "XYZ"[column]);
  }
  return "its x, y, z point along " + out;
}

/// Nothing for a turn about no axis of its own.
std::optional<std::string> quarter_turn(const Matrix3d& S) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const int deg : {90, 180, -90}) {
      const Matrix3d turn =
          Eigen::AngleAxisd(deg * std::numbers::pi / 180, Eigen::Vector3d::Unit(axis)).toRotationMatrix();
      if ((S.transpose() - turn).norm() < 1e-9)
        return fmt::format("turned by {} deg about {}", deg, "xyz"[axis]);
    }
  }
  return std::nullopt;
}

std::string mirror_in_words(const Matrix3d& S) {
  std::string reversed;
  for (int axis = 0; axis < 3; ++axis)
    if (S(axis, axis) < 0)
      reversed += reversed.empty() ? std::string(1, "xyz"[axis]) : fmt::format(", {}", "xyz"[axis]);
  if (S.isDiagonal() && !reversed.empty())
    return fmt::format("mirrored (left-handed axes: {} reversed)", reversed);
  for (int kept = 0; kept < 3; ++kept) {
    const int a = (kept + 1) % 3, b = (kept + 2) % 3;
    if (S(kept, kept) == 1 && S(a, b) == 1 && S(b, a) == 1)
      return fmt::format("mirrored (left-handed axes: {} and {} swapped)", "xyz"[std::min(a, b)],
                         "xyz"[std::max(a, b)]);
  }
  return fmt::format("mirrored (left-handed axes: {})", directions(S));
}

/// What all ways that fit have in common.
std::string in_words(const std::vector<Matrix3d>& ways) {
  if (ways.empty())
    return "reads another field, whichever way it is turned: look at its range, scale and supply";
  if (ways.size() == 1) return run::in_words(ways.front());
  if (all_of(ways, mirrored)) return "mirrored (left-handed axes); which ones, further attitudes will tell";
  if (all_of(ways, [](const Matrix3d& S) { return !mirrored(S); }))
    return "turned; about which axis, further attitudes will tell";
  return "turned or mirrored; which, further attitudes will tell";
}

}  // namespace

std::string in_words(const Eigen::Matrix3d& S) {
  if (S.isIdentity()) return "as the others";
  if (mirrored(S)) return mirror_in_words(S);
  return quarter_turn(S).value_or(fmt::format("turned ({})", directions(S)));
}

std::string alike_in_words(std::size_t sensors) {
  if (sensors == 1) return "one sensor: there is no other to compare it with";
  return sensors == kSensorCount ? "all four alike" : fmt::format("all {} alike", sensors);
}

void Wiring::add(const PerSensor<Eigen::Vector3d>& y_nT, const std::optional<TableAngles>& angles) {
  PerSensor<double> f_nT(0);
  for (const Eigen::Vector3d& y : y_nT) f_nT.push_back(y.norm());
  std::sort(f_nT.begin(), f_nT.end());
  const std::size_t n = f_nT.size();
  const double field_nT = (f_nT[(n - 1) / 2] + f_nT[n / 2]) / 2;  // the median: one sensor may be foreign
  if (!(field_nT > 0)) return;
  Seen seen{.y = y_nT, .R_PS = std::nullopt};
  for (Eigen::Vector3d& y : seen.y) y /= field_nT;
  if (angles)
    seen.R_PS =
        calib::sensor::table_rotation(angles->azimuth_rad, angles->pitch_rad, angles->roll_rad, 0.0, 0.0);
  seen_.push_back(seen);
}

Wiring::Ways Wiring::against(std::size_t slot, std::size_t reference) const {
  return fitting([&](const Matrix3d& S) {
    double square = 0;
    for (const Seen& seen : seen_) square += (seen.y[slot] - S * seen.y[reference]).squaredNorm();
    return std::sqrt(square / static_cast<double>(seen_.size()));
  });
}

std::optional<Wiring::Ways> Wiring::against_table(std::size_t reference) const {
  std::vector<const Seen*> turned;
  for (const Seen& seen : seen_)
    if (seen.R_PS) turned.push_back(&seen);
  if (turned.size() < kAttitudes) return std::nullopt;
  return fitting([&](const Matrix3d& S) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    double square = 0;
    const auto n = static_cast<double>(turned.size());
    const auto field = [&](const Seen& seen) -> Eigen::Vector3d {
      return seen.R_PS->transpose() * (S.transpose() * seen.y[reference]);
    };
    for (const Seen* seen : turned) mean += field(*seen) / n;
    for (const Seen* seen : turned) square += (field(*seen) - mean).squaredNorm();
    return std::sqrt(square / n);
  });
}

std::size_t Wiring::reference() const {
  const std::size_t sensors = seen_.front().y.size();
  std::size_t best = 0, most = 0;
  for (std::size_t candidate = 0; candidate < sensors; ++candidate) {
    std::size_t agree = 0;
    for (std::size_t slot = 0; slot < sensors; ++slot) agree += straight(against(slot, candidate)) ? 1U : 0U;
    if (agree > most) {
      most = agree;
      best = candidate;
    }
  }
  return best;
}

std::vector<std::string> Wiring::findings() const {
  std::vector<std::string> out;
  if (seen_.empty()) return out;
  const std::size_t by = reference();
  for (std::size_t slot = 0; slot < seen_.front().y.size(); ++slot) {
    const Ways ways = against(slot, by);
    if (!straight(ways)) out.push_back(fmt::format("s{}: {}", slot + 1, in_words(ways)));
  }
  const auto table = against_table(by);
  if (!table || straight(*table)) return out;
  out.push_back(
      table->empty() ? "the readings do not follow the angles of the table: look at its axes"
      : all_of(*table, mirrored)
          ? "the sensors are mirrored against the table: an axis of it counts the other way, or all "
            "sensors are left-handed"
          : "the array is turned against the table: " + in_words(*table));
  return out;
}

}  // namespace mgtd::daemon::run
