// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/law_ranking.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>

#include "calib/discovery/fitted_law.h"

namespace mgtd::calib::discovery {
namespace {

/// Sum of exp(q / 2) without overflow.
struct LogSum {
  double largest{0};
  double sum{0};
  int count{0};
  void add(double q) {
    if (count++ == 0 || q > largest) {
      sum = sum * std::exp((largest - q) / 2) + 1;
      largest = q;
    } else {
      sum += std::exp((q - largest) / 2);
    }
  }
  /// 2 ln of the mean over n.
  [[nodiscard]] double two_ln_mean(double n) const { return largest + 2 * std::log(sum / n); }
};

/// Steps of the golden section from the grid's interval to where S falls by no more than a hundredth: S is a
/// parabola about its largest value, which falls by about S over that interval.
int steps_for(double S) {
  constexpr double kFall = 0.01;
  if (!(S > kFall)) return 14;
  return std::max(14,
                  static_cast<int>(std::ceil(std::log(std::sqrt(S / kFall)) / std::log(std::numbers::phi))));
}

}  // namespace

double price_paid(double S, int k) { return S - k * std::log1p(S); }

std::vector<RankedLaw> rank_formulas(const std::vector<Tried>& tried, const FormulaValues& values,
                                     int channels) {
  struct Group {
    RankedLaw law;
    LogSum evidence;
    double best_q{0};
  };
  std::map<std::tuple<std::size_t, Place::Kind, int>, Group> groups;
  for (const Tried& t : tried) {
    const FormulaValues::Member& m = values.members()[t.member];
    const Family& family = values.grammar().families[m.family];
    Group& group = groups[{m.family, t.place.kind, t.place.at}];
    const double q = price_paid(t.S, t.k);
    if (group.evidence.count == 0 || q > group.best_q) {
      group.best_q = q;
      group.law = {.family = m.family,
                   .place = t.place,
                   .where = t.place.name(),
                   .inner = family.inner[m.inner],
                   .k = t.k,
                   .symbols = family.symbols,
                   .S = t.S};
    }
    group.evidence.add(q);
  }
  std::vector<RankedLaw> out;
  for (auto& [key, group] : groups) {
    const auto n = static_cast<double>(values.grammar().families[group.law.family].inner.size());
    group.law.score = group.evidence.two_ln_mean(n) - 2 * std::log(group.law.place.alike(channels)) -
                      2 * kSymbolPrice * group.law.symbols;
    out.push_back(std::move(group.law));
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const RankedLaw& a, const RankedLaw& b) { return a.score > b.score; });
  return out;
}

Result<void> refine_inner(std::vector<RankedLaw>& laws, std::size_t count, const Grammar& grammar,
                          LawInputs& inputs, const ChannelSums& sums) {
  constexpr double kGolden = 0.3819660112501051;
  for (std::size_t i = 0; i < std::min(count, laws.size()); ++i) {
    RankedLaw& law = laws[i];
    if (law.kind != RankedLaw::Kind::formula) continue;
    const Family& family = grammar.families[law.family];
    if (!family.refined || family.inner.size() < 2) continue;
    const auto at = std::min_element(family.inner.begin(), family.inner.end(), [&](double a, double b) {
      return std::abs(a - law.inner) < std::abs(b - law.inner);
    });
    double low = at == family.inner.begin() ? *at : *(at - 1);
    double high = at + 1 == family.inner.end() ? *at : *(at + 1);
    if (low > high) std::swap(low, high);
    const double before = law.S;
    const auto S_at = [&](double inner) -> Result<double> {
      const auto fitted = fitted_law(family.columns(inner), law.place, inputs, sums);
      if (!fitted) return tl::unexpected(fitted.error());
      if (fitted->k == law.k && fitted->S > law.S) law.S = fitted->S, law.inner = inner;
      return fitted->k == law.k ? fitted->S : 0;
    };
    // By golden section: Boost.Math's brent_find_minima has no way to say that a value cannot be fitted.
    double a = low + kGolden * (high - low), b = high - kGolden * (high - low);
    auto of_a = S_at(a), of_b = S_at(b);
    const int steps = steps_for(law.S);
    for (int step = 0; step < steps && of_a && of_b; ++step) {
      if (*of_a > *of_b) {
        high = b, b = a, of_b = of_a;
        a = low + kGolden * (high - low);
        of_a = S_at(a);
      } else {
        low = a, a = b, of_a = of_b;
        b = high - kGolden * (high - low);
        of_b = S_at(b);
      }
    }
    if (!of_a) return tl::unexpected(of_a.error());
    if (!of_b) return tl::unexpected(of_b.error());
    law.score += law.S - before;
  }
  std::stable_sort(laws.begin(), laws.end(),
                   [](const RankedLaw& a, const RankedLaw& b) { return a.score > b.score; });
  return {};
}

void share_probability(std::vector<RankedLaw>& laws) {
  std::stable_sort(laws.begin(), laws.end(),
                   [](const RankedLaw& a, const RankedLaw& b) { return a.score > b.score; });
  double sum = 0;
  for (RankedLaw& law : laws) sum += law.P = std::exp((law.score - laws.front().score) / 2);
  for (RankedLaw& law : laws) law.P /= sum;
}

}  // namespace mgtd::calib::discovery
