// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/multiplicity.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>

#include "calib/linear/normal_draws.h"
#include "calib/linear/parts.h"
#include "calib/stats/chi_square.h"

namespace mgtd::calib::criticism::tests {
namespace {

constexpr int kDraws = 1000;
/// Of a searched number so many values take part in the draws of all families together: neighbours are
/// alike. Draws of one family have all of them.
constexpr std::size_t kTogether = 3;
/// Share of the draws that decides about m.
constexpr double kLower = 1.0 / 3;

std::vector<std::size_t> drawn(const ScoredFamily& family, std::size_t most) {
  const std::size_t n = family.signatures.size(), m = std::min(n, most);
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < m; ++i) out.push_back(m < 2 ? 0 : i * (n - 1) / (m - 1));
  return out;
}

/// log10 of the chi-square tail on a grid, for one k.
class Tail {
 public:
  explicit Tail(int k) {
    const double end = k + 80 + 10 * std::sqrt(k);
    for (double S = 0; S <= end; S += kStep) values_.push_back(stats::chi_square_log10_p(S, k));
  }
  [[nodiscard]] double operator()(double S) const {
    const double x = std::min(S / kStep, static_cast<double>(values_.size()) - 1.001);
    const auto i = static_cast<std::size_t>(x);
    const double part = x - static_cast<double>(i);
    return values_[i] * (1 - part) + values_[i + 1] * part;
  }

 private:
  static constexpr double kStep = 0.1;
  std::vector<double> values_;
};

/// Unit-length columns of all families side by side: where each begins, and draws of their sums.
struct Draws {
  std::vector<std::vector<std::pair<std::size_t, Eigen::Index>>> first;  ///< family -> (variant, column)
  Eigen::VectorXd length;
  Eigen::MatrixXd sums;  ///< columns x draws
};

Draws draw(std::span<const ScoredFamily> families, std::size_t most, std::uint64_t seed) {
  Draws out;
  Eigen::Index m = 0;
  std::vector<Signature::Combination> all;
  for (const ScoredFamily& family : families) {
    out.first.emplace_back();
    for (const std::size_t v : drawn(family, most)) {
      const Signature& s = family.signatures[v];
      out.first.back().emplace_back(v, m);
      m += s.cols();
      all.push_back({&s, s.seen()});
    }
  }
  Eigen::MatrixXd gram = Signature::gram_of(all);
  out.length = gram.diagonal().cwiseMax(0).cwiseSqrt();
  const Eigen::VectorXd inverse = (out.length.array() > 0).select(out.length.cwiseInverse(), 0.0);
  gram = inverse.asDiagonal() * gram * inverse.asDiagonal();
  out.sums = linear::normal_draws(gram, kDraws, seed);
  return out;
}

/// By rank and price, of the questions that have both in common: the largest S, by draw.
using LargestS = std::map<std::pair<int, int>, Eigen::ArrayXd>;

LargestS largest_of(const ScoredFamily& family, const Draws& draws, std::size_t f) {
  LargestS largest;
  for (const auto& [v, at] : draws.first[f]) {
    const Signature& s = family.signatures[v];
    const Eigen::Index m = s.cols();
    const Eigen::MatrixXd sums = draws.length.segment(at, m).asDiagonal() * draws.sums.middleRows(at, m);
    for (const Hypothesis& h : family.candidate_effect->hypotheses) {
      const Eigen::MatrixXd basis = orthonormal_combinations(s, h);
      if (basis.cols() == 0) continue;
      const Eigen::ArrayXd S = (basis.transpose() * sums).colwise().squaredNorm().transpose().array();
      auto& top = largest[{static_cast<int>(basis.cols()), h.alike}];
      top = top.size() == 0 ? S : top.max(S).eval();
    }
  }
  return largest;
}

/// Smallest priced log10 p of a family, by draw.
std::vector<double> smallest(const LargestS& largest, std::map<int, Tail>& tails) {
  std::vector<double> out(kDraws, 0.0);
  for (const auto& [kind, S] : largest) {
    const Tail& tail = tails.try_emplace(kind.first, kind.first).first->second;
    const double price = std::log10(kind.second);
    for (Eigen::Index i = 0; i < S.size(); ++i) {
      double& l = out[static_cast<std::size_t>(i)];
      l = std::min(l, tail(S[i]) + price);
    }
  }
  return out;
}

}  // namespace

double questions_asked(std::vector<double> log10_p) {
  const auto count = static_cast<std::size_t>(kLower * static_cast<double>(log10_p.size()));
  std::nth_element(log10_p.begin(), log10_p.begin() + static_cast<std::ptrdiff_t>(count), log10_p.end());
  const auto exposure = [](double l) { return -std::log1p(-std::min(std::pow(10.0, l), 1 - 1e-12)); };
  const double limit = exposure(log10_p[count]);
  double sum = limit * static_cast<double>(log10_p.size() - count);
  for (std::size_t i = 0; i < count; ++i) sum += exposure(log10_p[i]);
  return static_cast<double>(count) / sum;
}

double best_of(double log10_p, double m) {
  if (log10_p < -10) return log10_p + std::log10(m);
  return std::log10(-std::expm1(m * std::log1p(-std::pow(10.0, std::min(log10_p, -1e-12)))));
}

Rates draw_rates(const std::vector<ScoredFamily>& families, std::uint64_t seed) {
  Rates out;
  if (families.empty()) return out;
  const std::size_t n = families.size();
  std::vector<LargestS> among_all(n), alone(n);
  linear::for_each_part(n + 1, [&](std::size_t part) {
    if (part == 0) {
      const Draws draws = draw(families, kTogether, seed);
      for (std::size_t f = 0; f < n; ++f) among_all[f] = largest_of(families[f], draws, f);
      return;
    }
    const std::size_t f = part - 1, values = families[f].signatures.size();
    if (values > kTogether)
      alone[f] = largest_of(families[f], draw({&families[f], 1}, values, seed + part), 0);
  });
  std::map<int, Tail> tails;
  std::vector<double> best(kDraws, 0.0);
  for (std::size_t f = 0; f < n; ++f) {
    const std::vector<double> own = smallest(among_all[f], tails);
    const double m = questions_asked(own);
    for (std::size_t i = 0; i < own.size(); ++i) best[i] = std::min(best[i], best_of(own[i], m));
    const bool scanned = families[f].signatures.size() > kTogether;
    out.family[families[f].candidate_effect->name] = scanned ? questions_asked(smallest(alone[f], tails)) : m;
  }
  out.best = std::max(1.0, questions_asked(std::move(best)));
  return out;
}

bool calibrate(std::vector<ScoredFamily>& families, const Rates& rates) {
  bool all = true;
  for (ScoredFamily& family : families) {
    const auto rate = rates.family.find(family.candidate_effect->name);
    all = all && rate != rates.family.end();
    family.asked = rate == rates.family.end() ? 1 : rate->second;
    family.calibrated = best_of(std::min(0.0, family.priced), family.asked);
  }
  return all;
}

}  // namespace mgtd::calib::criticism::tests
