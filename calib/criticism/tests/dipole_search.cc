// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/dipole_search.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "calib/linear/ldlt.h"

namespace mgtd::calib::criticism::tests {
namespace {

constexpr double kNearest_m = 0.3, kFarthest_m = 5;
constexpr std::array kDistances_m{0.6, 1.5};
/// Beside a gradient of the site, which takes up the gradient of a dipole, the dipole is known by its
/// curvature alone, and more places look alike.
constexpr std::size_t kStarts = 3, kPairStarts = 8;
/// Cosine of two directions from which a better start counts as the same.
constexpr double kSame = 0.8;
constexpr int kSteps = 12, kPairSteps = 40;
constexpr double kLongest = 0.4;  ///< step, of the distance
/// Gain of S that is no more worth a step; of two dipoles, of what is left too: where the residual is far
/// above the noise, S is in units of the residual.
constexpr double kEnoughGain = 0.05;
constexpr double kFirstDamping = 1e-3, kMostDamping = 1e3;

using Places = std::vector<Eigen::Vector3d>;  ///< site frame, m

struct Trial {
  Places at_S_m{};
  double S{0};
  Eigen::VectorXd moments_Am2{};
};

/// Moments that fit the residual best, to these places; S stays zero where the places cannot be told apart.
Trial solved(Places at_S_m, const Eigen::MatrixXd& gram, const Eigen::VectorXd& by_residual) {
  Trial out{.at_S_m = std::move(at_S_m), .moments_Am2 = Eigen::VectorXd::Zero(by_residual.size())};
  const Eigen::LDLT<Eigen::MatrixXd> ldlt(gram);
  if (ldlt.info() != Eigen::Success || !(ldlt.vectorD().minCoeff() > 0)) return out;
  out.moments_Am2 = ldlt.solve(by_residual);
  out.S = out.moments_Am2.dot(by_residual);
  return out;
}

/// Directions to faces, edges and corners of a cube, at each distance.
Places grid() {
  Places out;
  for (int cell = 0; cell < 27; ++cell) {
    const Eigen::Vector3d d(cell % 3 - 1, cell / 3 % 3 - 1, cell / 9 - 1);
    if (d.squaredNorm() == 0) continue;
    for (const double distance_m : kDistances_m) out.emplace_back(distance_m * d.normalized());
  }
  return out;
}

bool near(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return a.normalized().dot(b.normalized()) > kSame;
}

/// Whether each place of one lies in a direction of the other.
bool next_to(const Trial& a, const Trial& b) {
  return std::all_of(a.at_S_m.begin(), a.at_S_m.end(), [&](const Eigen::Vector3d& p) {
    return std::any_of(b.at_S_m.begin(), b.at_S_m.end(),
                       [&](const Eigen::Vector3d& q) { return near(p, q); });
  });
}

/// Those of large S that are not next to a larger one.
std::vector<Trial> best_apart(std::vector<Trial> all, std::size_t most) {
  std::sort(all.begin(), all.end(), [](const Trial& a, const Trial& b) { return a.S > b.S; });
  std::vector<Trial> out;
  for (Trial& trial : all) {
    if (out.size() == most) break;
    if (std::none_of(out.begin(), out.end(), [&](const Trial& better) { return next_to(trial, better); }))
      out.push_back(std::move(trial));
  }
  return out;
}

/// Coefficients of a dipole that stands where it stands.
Eigen::VectorXd moment_and_shift(const Eigen::Vector3d& moment_Am2) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(6);
  out.head<3>() = moment_Am2;
  return out;
}

class DipoleSearch {
 public:
  DipoleSearch(const fit::joint::JointProblem& problem, const fit::joint::JointState& state,
               const Residual& residual, const DipoleAt& dipole, const Eigen::MatrixXd& beside)
      : problem_(problem), state_(state), residual_(residual), dipole_(dipole), beside_(beside) {}

  [[nodiscard]] std::optional<Trial> best(int count) const {
    std::optional<Trial> out;
    for (const Trial& start : count == 1 ? single_starts() : pair_starts()) {
      Trial trial = climbed(start);
      if (!out || trial.S > out->S) out = std::move(trial);
    }
    if (!out || !(out->S > 0)) return std::nullopt;
    return out;
  }

  /// Columns of moment and shift at one place with its moment.
  [[nodiscard]] Signature both(const effects::EffectPtr& effect, const Eigen::Vector3d& moment_Am2) const {
    return {residual_, effect_source(problem_, state_, effect, moment_and_shift(moment_Am2))};
  }

 private:
  /// What acts beside the dipoles, taken out.
  [[nodiscard]] Eigen::MatrixXd without_beside(Eigen::MatrixXd columns) const {
    if (beside_.cols() > 0) columns -= (beside_ * (beside_.transpose() * columns)).eval();
    return columns;
  }

  /// Projected columns of the moment at one place; empty where the law has none there.
  [[nodiscard]] Eigen::MatrixXd moment_columns(const Eigen::Vector3d& place_S_m) const {
    const auto effect = dipole_(place_S_m);
    if (!effect) return {};
    return without_beside(residual_.project(effect_rows(problem_, state_, *effect).leftCols<3>()).projected);
  }

  [[nodiscard]] Trial at(const Places& at_S_m) const {
    Eigen::MatrixXd Z(residual_.value().size(), 3 * static_cast<Eigen::Index>(at_S_m.size()));
    for (std::size_t i = 0; i < at_S_m.size(); ++i) {
      const Eigen::MatrixXd own = moment_columns(at_S_m[i]);
      if (own.cols() == 0) return {.at_S_m = at_S_m, .moments_Am2 = Eigen::VectorXd::Zero(Z.cols())};
      Z.middleCols<3>(3 * static_cast<Eigen::Index>(i)) = own;
    }
    return solved(at_S_m, Z.transpose() * Z, Z.transpose() * residual_.value());
  }

  [[nodiscard]] std::vector<Trial> single_starts() const {
    std::vector<Trial> all;
    for (const Eigen::Vector3d& place_S_m : grid()) all.push_back(at({place_S_m}));
    return best_apart(std::move(all), beside_.cols() == 0 ? kStarts : kPairStarts);
  }

  [[nodiscard]] std::vector<Trial> pair_starts() const {
    const Places places = grid();
    Eigen::MatrixXd Z(residual_.value().size(), 3 * static_cast<Eigen::Index>(places.size()));
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Eigen::MatrixXd own = moment_columns(places[i]);
      if (own.cols() == 0) return {};
      Z.middleCols<3>(3 * static_cast<Eigen::Index>(i)) = own;
    }
    const Eigen::MatrixXd gram = Z.transpose() * Z;
    const Eigen::VectorXd by_residual = Z.transpose() * residual_.value();
    std::vector<Trial> all;
    Eigen::MatrixXd G(6, 6);
    Eigen::VectorXd g(6);
    for (std::size_t i = 0; i < places.size(); ++i) {
      for (std::size_t j = i + 1; j < places.size(); ++j) {
        const auto a = 3 * static_cast<Eigen::Index>(i), b = 3 * static_cast<Eigen::Index>(j);
        G << gram.block<3, 3>(a, a), gram.block<3, 3>(a, b), gram.block<3, 3>(b, a), gram.block<3, 3>(b, b);
        g << by_residual.segment<3>(a), by_residual.segment<3>(b);
        all.push_back(solved({places[i], places[j]}, G, g));
      }
    }
    return best_apart(std::move(all), kPairStarts);
  }

  [[nodiscard]] Trial climbed(Trial trial) const {
    double damping = kFirstDamping;
    const bool single = trial.at_S_m.size() == 1;
    for (int i = 0; i < (single ? kSteps : kPairSteps) && damping < kMostDamping; ++i) {
      const auto direction = direction_at(trial);
      if (!direction) return trial;
      double gain = 0;
      for (; damping < kMostDamping; damping *= 10) {
        Trial next = at(stepped(trial, *direction, damping));
        gain = next.S - trial.S;
        if (gain > 0) {
          trial = std::move(next);
          damping = std::max(kFirstDamping, damping / 10);
          break;
        }
      }
      if (gain < kEnoughGain * (single ? 1 : std::min(1.0, residual_.chi2() - trial.S))) break;
    }
    return trial;
  }

  /// Normal equations of moments, then shifts, about a trial.
  struct Direction {
    Eigen::MatrixXd gram;
    Eigen::VectorXd by_left;  ///< columns times what the moments leave of the residual
  };

  [[nodiscard]] std::optional<Direction> direction_at(const Trial& trial) const {
    const auto count = static_cast<Eigen::Index>(trial.at_S_m.size());
    Eigen::MatrixXd Z(residual_.value().size(), 6 * count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const auto effect = dipole_(trial.at_S_m[static_cast<std::size_t>(i)]);
      if (!effect) return std::nullopt;
      const Eigen::MatrixXd own =
          without_beside(residual_
                             .project(effect_rows(problem_, state_, *effect,
                                                  moment_and_shift(trial.moments_Am2.segment<3>(3 * i))))
                             .projected);
      Z.middleCols<3>(3 * i) = own.leftCols<3>();
      Z.middleCols<3>(3 * (count + i)) = own.rightCols<3>();
    }
    Direction out{.gram = Z.transpose() * Z, .by_left = Z.transpose() * residual_.value()};
    // What is left once the moments are taken out; the priors hold nothing here.
    out.by_left -= out.gram.leftCols(3 * count) * trial.moments_Am2;
    return out;
  }

  [[nodiscard]] static Places stepped(const Trial& from, const Direction& direction, double damping) {
    const auto shifts = 3 * static_cast<Eigen::Index>(from.at_S_m.size());
    Eigen::MatrixXd M = direction.gram;
    M.diagonal().tail(shifts) *= 1 + damping;
    const Eigen::VectorXd all = linear::solve_by_scaled_ldlt(M, direction.by_left).tail(shifts);
    Places out;
    for (std::size_t i = 0; i < from.at_S_m.size(); ++i) {
      Eigen::Vector3d step = all.segment<3>(3 * static_cast<Eigen::Index>(i));
      if (!step.allFinite()) step.setZero();
      const double longest_m = kLongest * from.at_S_m[i].norm();
      if (step.norm() > longest_m) step *= longest_m / step.norm();
      const Eigen::Vector3d to = from.at_S_m[i] + step;
      out.emplace_back(to * (std::clamp(to.norm(), kNearest_m, kFarthest_m) / to.norm()));
    }
    return out;
  }

  const fit::joint::JointProblem& problem_;
  const fit::joint::JointState& state_;
  const Residual& residual_;
  const DipoleAt& dipole_;
  const Eigen::MatrixXd& beside_;
};

}  // namespace

std::optional<FoundDipole> find_dipole(const fit::joint::JointProblem& problem,
                                       const fit::joint::JointState& state, const Residual& residual,
                                       const DipoleAt& dipole) {
  const Eigen::MatrixXd nothing(residual.value().size(), 0);
  const DipoleSearch search(problem, state, residual, dipole, nothing);
  const auto best = search.best(1);
  if (!best) return std::nullopt;
  auto effect = dipole(best->at_S_m.front());
  if (!effect) return std::nullopt;
  return FoundDipole{.effect = *effect, .signature = search.both(*effect, best->moments_Am2)};
}

std::optional<FoundDipoles> find_dipoles(const fit::joint::JointProblem& problem,
                                         const fit::joint::JointState& state, const Residual& residual,
                                         const DipoleAt& dipole, int count, const Eigen::MatrixXd& beside) {
  const auto best = DipoleSearch(problem, state, residual, dipole, beside).best(count);
  if (!best) return std::nullopt;
  FoundDipoles out{.moments_Am2 = best->moments_Am2,
                   .S = best->S + (beside.transpose() * residual.value()).squaredNorm()};
  for (const Eigen::Vector3d& place_S_m : best->at_S_m) {
    auto effect = dipole(place_S_m);
    if (!effect) return std::nullopt;
    out.effects.push_back(*std::move(effect));
  }
  return out;
}

}  // namespace mgtd::calib::criticism::tests
