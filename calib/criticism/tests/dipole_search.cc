// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/dipole_search.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "calib/linear/ldlt.h"

namespace mgtd::calib::criticism::tests {
namespace {

constexpr double kNearest_m = 0.3, kFarthest_m = 3;
constexpr std::array kDistances_m{0.6, 1.5};
constexpr std::size_t kStarts = 3;
/// Cosine of two directions from which a better start counts as the same.
constexpr double kSame = 0.8;
constexpr int kSteps = 12;
constexpr double kLongest = 0.4;      ///< step, of the distance
constexpr double kEnoughGain = 0.05;  ///< gain of S that is no more worth a step
constexpr double kFirstDamping = 1e-3, kMostDamping = 1e3;

struct DipolePlace {
  Eigen::Vector3d at_S_m;
  double S{0};
  Eigen::Vector3d moment{0, 0, 0};
};

class DipoleSearch {
 public:
  DipoleSearch(const fit::joint::JointProblem& problem, const fit::joint::JointState& state,
               const Residual& residual, const DipoleAt& dipole)
      : problem_(problem), state_(state), residual_(residual), dipole_(dipole) {}

  [[nodiscard]] DipolePlace at(const Eigen::Vector3d& place_S_m) const {
    DipolePlace out{.at_S_m = place_S_m};
    const auto effect = dipole_(place_S_m);
    if (!effect) return out;
    const Signature s = signature_of(residual_, effect_rows(problem_, state_, *effect).leftCols<3>());
    const Eigen::LDLT<Eigen::Matrix3d> ldlt(s.gram);
    if (ldlt.info() != Eigen::Success || !(ldlt.vectorD().minCoeff() > 0)) return out;
    out.moment = ldlt.solve(s.by_residual);
    out.S = out.moment.dot(s.by_residual);
    return out;
  }

  /// Directions to faces, edges and corners of a cube, those of large S that are not next to a larger one.
  [[nodiscard]] std::vector<DipolePlace> starts() const {
    std::vector<DipolePlace> all, out;
    for (int cell = 0; cell < 27; ++cell) {
      const Eigen::Vector3d d(cell % 3 - 1, cell / 3 % 3 - 1, cell / 9 - 1);
      if (d.squaredNorm() == 0) continue;
      for (const double distance_m : kDistances_m) all.push_back(at(distance_m * d.normalized()));
    }
    std::sort(all.begin(), all.end(), [](const DipolePlace& a, const DipolePlace& b) { return a.S > b.S; });
    for (const DipolePlace& p : all) {
      const bool next_to = std::any_of(out.begin(), out.end(), [&](const DipolePlace& q) {
        return p.at_S_m.normalized().dot(q.at_S_m.normalized()) > kSame;
      });
      if (!next_to && out.size() < kStarts) out.push_back(p);
    }
    return out;
  }

  [[nodiscard]] Signature both(const DipolePlace& place, const effects::EffectPtr& effect) const {
    Eigen::VectorXd c = Eigen::VectorXd::Zero(6);
    c.head<3>() = place.moment;
    return signature_of(residual_, effect_rows(problem_, state_, effect, c));
  }

  [[nodiscard]] DipolePlace climbed(DipolePlace place) const {
    double damping = kFirstDamping;
    for (int i = 0; i < kSteps && damping < kMostDamping; ++i) {
      const auto effect = dipole_(place.at_S_m);
      if (!effect) return place;
      const Signature s = both(place, *effect);
      double gain = 0;
      for (; damping < kMostDamping; damping *= 10) {
        const DipolePlace next = at(stepped(place, s, damping));
        gain = next.S - place.S;
        if (gain > 0) {
          place = next;
          damping = std::max(kFirstDamping, damping / 10);
          break;
        }
      }
      if (gain < kEnoughGain) break;
    }
    return place;
  }

 private:
  [[nodiscard]] static Eigen::Vector3d stepped(const DipolePlace& from, const Signature& s, double damping) {
    Eigen::MatrixXd M = s.gram;
    M.diagonal().tail<3>() *= 1 + damping;
    // What is left once the moment is taken out; the priors hold nothing here.
    Eigen::VectorXd g = s.by_residual;
    g -= s.gram.leftCols<3>() * from.moment;
    const Eigen::VectorXd d = M.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    const Eigen::VectorXd scaled =
        linear::solve_by_ldlt(d.asDiagonal() * M * d.asDiagonal(), Eigen::VectorXd(d.cwiseProduct(g)));
    Eigen::Vector3d step = d.cwiseProduct(scaled).tail<3>();
    if (!step.allFinite()) step.setZero();
    const double distance_m = from.at_S_m.norm(), longest_m = kLongest * distance_m;
    if (step.norm() > longest_m) step *= longest_m / step.norm();
    const Eigen::Vector3d to = from.at_S_m + step;
    return to * (std::clamp(to.norm(), kNearest_m, kFarthest_m) / to.norm());
  }

  const fit::joint::JointProblem& problem_;
  const fit::joint::JointState& state_;
  const Residual& residual_;
  const DipoleAt& dipole_;
};

}  // namespace

std::optional<FoundDipole> find_dipole(const fit::joint::JointProblem& problem,
                                       const fit::joint::JointState& state, const Residual& residual,
                                       const DipoleAt& dipole) {
  const DipoleSearch search(problem, state, residual, dipole);
  std::optional<DipolePlace> best;
  for (const DipolePlace& start : search.starts()) {
    DipolePlace place = search.climbed(start);
    if (!best || place.S > best->S) best = place;
  }
  if (!best || !(best->S > 0)) return std::nullopt;
  auto effect = dipole(best->at_S_m);
  if (!effect) return std::nullopt;
  return FoundDipole{.effect = *effect, .signature = search.both(*best, *effect)};
}

}  // namespace mgtd::calib::criticism::tests
