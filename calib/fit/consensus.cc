// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/consensus.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "calib/linear/ldlt.h"
#include "calib/linear/symmetric_eigen.h"
#include "calib/stats/median.h"

namespace mgtd::calib::fit {
namespace {

using Which = std::vector<Eigen::Index>;
constexpr double kKeep = 0.6;              ///< share of the poses that is fitted: breaks down beyond 0.4
constexpr std::size_t kMost = 400;         ///< poses that are searched; the others are judged by the result
constexpr Eigen::Index kFewestPoses = 20;  ///< below, three fifths of the poses do not determine a rig
constexpr int kFinalists = 3, kConcentrations = 2, kMaxConcentrations = 30;
constexpr double kFlat = 0.2;  ///< of the thickness of all poses: a subset flatter than this is one turn
constexpr double kOneTurn = 0.02;
/// Times the median distance: in nine dimensions none of a million good poses is three medians away, in one
/// dimension six medians are four standard deviations.
constexpr double kNearPlane = 3, kNearEllipsoid = 6;
/// One axis may be that much noisier than another, in variance, before its misfit is more than noise.
constexpr double kUneven = 16;

double median(const Eigen::VectorXd& values) { return stats::median({values.begin(), values.end()}); }

/// The plane of some poses: its mean, the directions in it and across it.
struct Plane {
  sensor::FieldVector mean;
  sensor::ChannelRows<3> along;
  Eigen::MatrixXd across;        ///< no columns with one sensor
  sensor::FieldVector variance;  ///< ascending; the last three lie in the plane

  Plane(const ReadingTable& y, const Which& which) {
    const ReadingTable chosen = y(Eigen::all, which);
    mean = chosen.rowwise().mean();
    const ReadingTable z = chosen.colwise() - mean;
    const linear::SymmetricEigen eigen =
        linear::symmetric_eigen(z * z.transpose() / static_cast<double>(which.size()));
    along = eigen.vectors.rightCols<3>();
    across = eigen.vectors.leftCols(y.rows() - 3);
    variance = eigen.values.cwiseMax(0);
  }
  [[nodiscard]] double thickness() const {
    return std::sqrt(variance[variance.size() - 3] / variance[variance.size() - 1]);
  }
  [[nodiscard]] Eigen::VectorXd squares(const ReadingTable& y) const {
    return (across.transpose() * (y.colwise() - mean)).colwise().squaredNorm();
  }
  [[nodiscard]] Eigen::Matrix3Xd places(const ReadingTable& y) const {
    return along.transpose() * (y.colwise() - mean) / std::sqrt(variance[variance.size() - 1]);
  }
};

/// [x y z x^2 y^2 z^2 xy xz yz] w = 1 by least squares.
struct Quadric {
  static constexpr int kUnknowns = 9;
  Eigen::Matrix<double, kUnknowns, 1> w;

  static Eigen::Matrix<double, kUnknowns, Eigen::Dynamic> columns(const Eigen::Matrix3Xd& x) {
    Eigen::Matrix<double, kUnknowns, Eigen::Dynamic> out(kUnknowns, x.cols());
    const auto a = x.row(0).array(), b = x.row(1).array(), c = x.row(2).array();
    out.topRows<3>() = x;
    out.row(3) = a * a, out.row(4) = b * b, out.row(5) = c * c;
    out.row(6) = a * b, out.row(7) = a * c, out.row(8) = b * c;
    return out;
  }
  Quadric(const Eigen::Matrix3Xd& x, const Which& which) {
    const auto d = columns(x(Eigen::all, which));
    w = linear::solve_by_ldlt(d * d.transpose(), Eigen::VectorXd(d.rowwise().sum()));
  }
  [[nodiscard]] Eigen::VectorXd squares(const Eigen::Matrix3Xd& x) const {
    return (columns(x).transpose() * w - Eigen::VectorXd::Ones(x.cols())).array().square();
  }
  [[nodiscard]] std::optional<Eigen::Vector3d> centre() const {
    Eigen::Matrix3d Q;
    Q << w[3], w[6] / 2, w[7] / 2, w[6] / 2, w[4], w[8] / 2, w[7] / 2, w[8] / 2, w[5];
    const Eigen::LLT<Eigen::Matrix3d> llt(Q);
    if (llt.info() != Eigen::Success) return std::nullopt;
    return -0.5 * llt.solve(w.head<3>());
  }
};

/// The `count` smallest, and their sum.
struct Nearest {
  Which which;
  double sum{0};

  Nearest(const Eigen::VectorXd& squares, Eigen::Index count)
      : which(static_cast<std::size_t>(squares.size())) {
    std::iota(which.begin(), which.end(), 0);
    const auto end = which.begin() + count;
    std::nth_element(which.begin(), end - 1, which.end(),
                     [&](Eigen::Index a, Eigen::Index b) { return squares[a] < squares[b]; });
    which.erase(end, which.end());
    for (const Eigen::Index k : which) sum += squares[k];
  }
};

/// Least trimmed squares of a Model(data, which) with squares(data). `valid` refuses subsets that fit for the
/// wrong reason.
template <class Model, class Data>
std::optional<Model> trimmed(const Data& data, Eigen::Index subset, int draws, const auto& valid) {
  struct Found {
    double sum;
    Which which;
  };
  const Eigen::Index n = data.cols();
  const auto keep = static_cast<Eigen::Index>(std::ceil(kKeep * static_cast<double>(n)));
  std::mt19937 random(1);
  std::vector<Found> found;
  Which all(static_cast<std::size_t>(n));
  std::iota(all.begin(), all.end(), 0);
  const auto concentrate = [&](Which which, int times) -> std::optional<Found> {
    double before = std::numeric_limits<double>::infinity();
    for (int i = 0; i < times; ++i) {
      const Model model(data, which);
      Nearest nearest(model.squares(data), keep);
      which = std::move(nearest.which);
      if (!std::isfinite(nearest.sum)) return std::nullopt;
      if (!(nearest.sum < before * (1 - 1e-9))) break;
      before = nearest.sum;
    }
    if (!valid(Model(data, which))) return std::nullopt;
    return Found{before, std::move(which)};
  };
  for (int draw = 0; draw < draws; ++draw) {
    for (Eigen::Index j = 0; j < subset; ++j)
      std::swap(all[static_cast<std::size_t>(j)],
                all[static_cast<std::size_t>(j) + random() % static_cast<std::size_t>(n - j)]);
    if (auto one = concentrate({all.begin(), all.begin() + subset}, kConcentrations))
      found.push_back(*std::move(one));
  }
  const auto less = [](const Found& a, const Found& b) { return a.sum < b.sum; };
  std::sort(found.begin(), found.end(), less);
  if (found.size() > kFinalists) found.erase(found.begin() + kFinalists, found.end());
  std::optional<Found> best;
  for (const Found& one : found) {
    auto settled = concentrate(one.which, kMaxConcentrations);
    if (settled && (!best || settled->sum < best->sum)) best = std::move(settled);
  }
  if (!best) return std::nullopt;
  return Model(data, best->which);
}

Which within(const Eigen::VectorXd& squares, double medians) {
  const double limit = medians * medians * median(squares);
  Which out;
  for (Eigen::Index k = 0; k < squares.size(); ++k)
    if (squares[k] <= limit) out.push_back(k);
  return out;
}

/// So many of n as are searched, spread over the run.
Which searched(Eigen::Index n) {
  Which out(static_cast<std::size_t>(n));
  std::iota(out.begin(), out.end(), 0);
  std::mt19937 random(2);
  for (std::size_t j = 0; j < kMost && j < out.size(); ++j)
    std::swap(out[j], out[j + random() % (out.size() - j)]);
  if (out.size() > kMost) out.erase(out.begin() + kMost, out.end());
  return out;
}

/// Those of the places that lie on one ellipsoid, each brought to one field first.
Which on_ellipsoid(const Eigen::Matrix3Xd& x, const Eigen::VectorXd& f_nT) {
  constexpr Eigen::Index kSubset = 10;
  constexpr int kDraws = 100;
  Which everything(static_cast<std::size_t>(x.cols()));
  std::iota(everything.begin(), everything.end(), 0);
  const auto ellipsoid = [](const Quadric& q) { return q.centre().has_value(); };
  const Eigen::Matrix3Xd some = x(Eigen::all, searched(x.cols()));
  auto found = trimmed<Quadric>(some, kSubset, kDraws, ellipsoid);
  if (!found) return everything;
  const Eigen::Vector3d centre = *found->centre();
  const Eigen::VectorXd ratio = median(f_nT) * f_nT.cwiseInverse();
  const Eigen::Matrix3Xd scaled = ((x.colwise() - centre) * ratio.asDiagonal()).colwise() + centre;
  Which which = within(found->squares(scaled), kNearEllipsoid);
  return within(Quadric(scaled, which).squares(scaled), kNearEllipsoid);
}

}  // namespace

bool looks_spoilt(const ReadingTable& y_nT) {
  if (y_nT.cols() < kFewestPoses || y_nT.rows() == 3) return false;
  Which all(static_cast<std::size_t>(y_nT.cols()));
  std::iota(all.begin(), all.end(), 0);
  const Plane plane(y_nT, all);
  const Eigen::VectorXd squares = plane.squares(y_nT);
  if (squares.maxCoeff() > kNearPlane * kNearPlane * median(squares)) return true;
  const Eigen::Index across = y_nT.rows() - 3;
  return plane.variance[across - 1] > kUneven * plane.variance[across / 2];
}

namespace {

/// The plane that most poses lie in; empty where they turn about one axis only, or are too few to tell.
std::optional<Plane> common_plane(const ReadingTable& y_nT) {
  constexpr Eigen::Index kSubset = 5;
  constexpr int kDraws = 70;
  const ReadingTable some = y_nT(Eigen::all, searched(y_nT.cols()));
  Which all(static_cast<std::size_t>(some.cols()));
  std::iota(all.begin(), all.end(), 0);
  const double thickness = Plane(some, all).thickness();
  if (!(thickness > kOneTurn)) return std::nullopt;
  const auto solid = [&](const Plane& plane) { return plane.thickness() > kFlat * thickness; };
  const auto plane = trimmed<Plane>(some, kSubset, kDraws, solid);
  if (!plane) return std::nullopt;
  return Plane(y_nT, within(plane->squares(y_nT), kNearPlane));
}

std::optional<Which> if_most(Which which, Eigen::Index of) {
  if (static_cast<double>(which.size()) < 0.5 * static_cast<double>(of)) return std::nullopt;
  return which;
}

}  // namespace

std::optional<std::vector<Eigen::Index>> agreeing_poses(const ReadingTable& y_nT) {
  if (y_nT.cols() < kFewestPoses) return std::nullopt;
  const auto plane = common_plane(y_nT);
  if (!plane) return std::nullopt;
  return if_most(within(plane->squares(y_nT), kNearPlane), y_nT.cols());
}

std::optional<std::vector<Eigen::Index>> agreeing_poses(const ReadingTable& y_nT,
                                                        const Eigen::VectorXd& f_nT) {
  if (y_nT.cols() < kFewestPoses) return std::nullopt;
  if (y_nT.rows() == 3) return if_most(on_ellipsoid(y_nT, f_nT), y_nT.cols());
  const auto plane = common_plane(y_nT);
  if (!plane) return std::nullopt;
  const Which near = within(plane->squares(y_nT), kNearPlane);
  const Which kept = on_ellipsoid(plane->places(y_nT)(Eigen::all, near), f_nT(near));
  Which out;
  for (const Eigen::Index j : kept) out.push_back(near[static_cast<std::size_t>(j)]);
  return if_most(std::move(out), y_nT.cols());
}

}  // namespace mgtd::calib::fit
