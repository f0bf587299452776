// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/two_step/step2.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "calib/fit/orientation.h"
#include "calib/linear/symmetric_eigen.h"
#include "proto/units.h"

namespace mgtd::calib::fit::two_step {
namespace {

constexpr std::size_t kMinStandard = 5;
/// Larger over smaller of |Bz| sqrt(N) and Bh sqrt(N/2): 20 is a field about 4 degrees from Z, or 2 from the
/// horizontal.
constexpr double kMaxCondition = 20;
/// Mean of cos and sin of the azimuths: a whole turn has none; 0.9 is a fan of about 90 degrees.
constexpr double kMaxFan = 0.9;
/// A standard pose tilted by more is not of a turn about platform Z with the table's axis upright.
constexpr double kLevel_rad = 1 * kRadiansPerDegree;

struct Turn {
  std::vector<Eigen::Index> poses;
  Eigen::VectorXd azimuth_rad;
};

Result<Turn> standard_turn(const Readings& readings) {
  Turn turn;
  std::vector<double> azimuths;
  for (Eigen::Index k = 0; k < readings.poses(); ++k) {
    const auto at = static_cast<std::size_t>(k);
    if (!readings.of_turn(k)) continue;
    const double tilt =
        std::max(std::abs(readings.angles[at]->pitch_rad), std::abs(readings.angles[at]->roll_rad));
    if (tilt > kLevel_rad) {
      return fail(
          ErrorCode::refused,
          fmt::format("a standard pose at azimuth {:.2f} deg is tilted by {:.2f} deg, limit {:.0f} deg",
                      to_deg(readings.angles[at]->azimuth_rad), to_deg(tilt), to_deg(kLevel_rad)),
          "the standard set is a turn of the level table about Z: give tilted poses another set");
    }
    turn.poses.push_back(k);
    azimuths.push_back(readings.angles[at]->azimuth_rad);
  }
  if (turn.poses.size() < kMinStandard) {
    return fail(ErrorCode::refused,
                fmt::format("{} poses of the set 'standard' with table angles; step 2 needs {}",
                            turn.poses.size(), kMinStandard),
                "measure the standard set (a level turn about Z), or use --method joint, which needs none");
  }
  turn.azimuth_rad =
      Eigen::Map<const Eigen::VectorXd>(azimuths.data(), static_cast<Eigen::Index>(azimuths.size()));
  const double fan = std::hypot(turn.azimuth_rad.array().cos().mean(), turn.azimuth_rad.array().sin().mean());
  if (fan > kMaxFan) {
    return fail(
        ErrorCode::refused,
        fmt::format("the standard poses do not go round: mean direction {:.2f}, limit {}", fan, kMaxFan),
        "turn the table through 360 degrees in steps of 10 or 20 degrees");
  }
  return turn;
}

/// One sensor's rows for Bz > 0, and its |Bz|.
struct Rows {
  Eigen::Matrix3d T;  ///< Tx, Ty, Tz
  double bz_nT{0};
  double condition{0};
};

Rows rows_of(const Eigen::Matrix3Xd& P, const Eigen::VectorXd& azimuth_rad) {
  const Eigen::Matrix3d normal = P * P.transpose();
  const Eigen::Vector3d e = linear::principal_axes(normal).values;
  const Eigen::LDLT<Eigen::Matrix3d> solver(normal);
  const Eigen::Vector3d u = solver.solve(P.rowwise().sum());
  Rows rows;
  rows.condition = e[0] > 0 ? std::sqrt(e[2] / e[0]) : std::numeric_limits<double>::infinity();
  rows.bz_nT = 1 / u.norm();
  rows.T.row(2) = u.normalized();
  // The length of these two is Bh over the true one; the nearest rotation removes it.
  rows.T.row(0) = solver.solve(P * azimuth_rad.array().cos().matrix()).normalized();
  rows.T.row(1) = solver.solve(P * (-azimuth_rad.array().sin()).matrix()).normalized();
  return rows;
}

}  // namespace

Result<Alignment> align(const Readings& readings, const PerSensor<Eigen::Matrix3Xd>& b_S_nT,
                        std::optional<double> bz_sign) {
  const auto turn = standard_turn(readings);
  if (!turn) return tl::unexpected(turn.error());
  Alignment out;
  out.R_PS.resize(b_S_nT.size());
  PerSensor<Rows> rows(b_S_nT.size());
  double bz = 0, handedness = 0;
  const double f = readings.mean_f_nT();
  // A field that drifts during the turn would look like a tilt.
  const Eigen::VectorXd to_mean = f * readings.f_nT(turn->poses).cwiseInverse();
  for (std::size_t i = 0; i < b_S_nT.size(); ++i) {
    rows[i] = rows_of(b_S_nT[i](Eigen::all, turn->poses) * to_mean.asDiagonal(), turn->azimuth_rad);
    out.condition = std::max(out.condition, rows[i].condition);
    bz += rows[i].bz_nT / static_cast<double>(b_S_nT.size());
    handedness += rows[i].T.determinant() > 0 ? 1 : -1;
  }
  if (!(out.condition < kMaxCondition)) {
    const bool along_z = bz > 0.5 * f;
    return fail(
        ErrorCode::refused,
        fmt::format("condition number {:.3g} of the standard set, limit {}: the field is {} ({:.0f} nT of "
                    "{:.0f} nT along it)",
                    out.condition, kMaxCondition,
                    along_z ? "along the axis of the turn" : "at right angles to the axis of the turn", bz,
                    f),
        "tilt the table axis by 20 degrees or more against this direction, or use --method joint with poses "
        "about several axes");
  }
  // Bz < 0 turns every Tz over: what looked mirrored is then right-handed.
  const double sign = bz_sign.value_or(handedness >= 0 ? 1.0 : -1.0);
  for (std::size_t i = 0; i < b_S_nT.size(); ++i) {
    rows[i].T.row(2) *= sign;
    out.R_PS[i] = nearest_orthogonal(rows[i].T, false);
  }
  out.bz_nT = sign * bz;
  out.bh_nT = std::sqrt(std::max(0.0, f * f - bz * bz));
  return out;
}

}  // namespace mgtd::calib::fit::two_step
