// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calib/discovery/fitted_law.h"
#include "calib/discovery/law_ranking.h"
#include "calib/discovery/law_shape.h"
#include "calib/fit/joint/joint_fit.h"

/// A DiscoveryReport holds what discover() (discover.h) finds, as values.
namespace mgtd::calib::discovery {

enum class LawFinding { pass, law, law_set, library, shape_only, noise_like };
[[nodiscard]] std::string_view to_string(LawFinding finding);

/// The rule of finding_of() that decided, with the number that it compared.
struct LawFindingReason {
  enum class Rule {
    nothing_found,   ///< PASS: log10 p of the search, not below its limit
    only_scatter,    ///< NOISE-LIKE: no formula, but an axis scatters (standard deviations of chi-square)
    only_wander,     ///< NOISE-LIKE: no formula, but the offsets wander
    walk_instead,    ///< NOISE-LIKE: log10 p of the law against offsets that wander, not below its limit
    random_instead,  ///< NOISE-LIKE: 2 ln of the odds against a random offset, below zero
    random_near,     ///< SHAPE-ONLY: the same, below its limit
    random_beside,   ///< SHAPE-ONLY: 2 ln of the odds of a random offset beside the laws, above zero
    drift,           ///< SHAPE-ONLY: may_be_drift()
    library,         ///< LIBRARY: P of an effect of the library, which leads
    few_periods,     ///< SHAPE-ONLY: periods of an oscillation that the run lasts, fewer than needed
    law_left,        ///< SHAPE-ONLY: log10 p of the search in what is left, below its limit
    scatter_left,    ///< SHAPE-ONLY: standard deviations of chi-square on an axis, above their limit
    formulas_open,   ///< LAW-SET: P of the leading formula, not above its limit
    none             ///< LAW
  };
  Rule rule{Rule::nothing_found};
  double measured{0}, limit{0};
  std::size_t law{0};  ///< of which it was asked
};

struct LawCoefficient {
  std::string where{};  ///< "s3.z"; a component of the gradient: "Gxx"
  double value{0}, sd{0};
  std::string unit{};  ///< per unit of the formula: "nT", of a gradient "nT/m"
};

/// A formula of the 99 % set.
struct FoundFormula {
  std::string formula{};  ///< for a person: T, x, y, z (readings without offset over 50 000 nT), t_h
  Columns columns{};      ///< as `mgt define` takes them
  std::string where{};
  std::vector<std::string> covariates{};
  std::string library{};             ///< the effect of the library that it is, or one that does as well
  std::vector<std::string> specs{};  ///< effects, as --with reads them; none for a library effect
  double P{0}, S{0}, size_nT{0};     ///< size: rms of the law over poses and axes where it acts
  int k{0}, symbols{0}, same_as{1};  ///< class: formulas of one number cannot be told apart on these poses
  double needed_nT{0};  ///< size at which it would be told from the first with 99 %; 0: the first;
                        ///< infinite: never, on these poses
  std::optional<double> inner{};
  std::string inner_unit{};
  std::vector<LawCoefficient> coefficients{};
};

struct Share {
  std::string name{};
  double P{0};
};

/// An effect of the library at a place.
struct LibraryEffect {
  std::string name{}, where{};
};

/// One law and what else it could be.
struct FoundLaw {
  std::vector<FoundFormula> formulas{};  ///< the 99 % set, best first; the first is in the model afterwards
  /// With a hundredth of the evidence of the best formula or more, beside the other laws.
  std::vector<LibraryEffect> as_well{};
  std::size_t more{0};  ///< formulas of the set that are not among these
  std::vector<Share> covariates{}, where{};
  double log10_p{0};  ///< of the whole search
  bool stands_out{false};
  double d{0};
  /// Of an offset that walks or jumps: instead of this law (law_sequence.h); where `random_beside`, beside
  /// it.
  double walk_P{0}, jumps_P{0};
  double over_walk{0}, over_jumps{0};  ///< 2 ln of the odds of all formulas against them instead of the law
  std::string random_where{};          ///< where those were asked about
  bool random_beside{false};      ///< they describe best what is left beside the laws, not instead of them
  double over_nothing_beside{0};  ///< 2 ln of the odds of that against laws alone
  std::optional<double> halves_ratio{}, held_out_fall{};
  std::optional<double> extrapolation_spread{};
  std::optional<LawShape> shape{};
};

struct DiscoveryReport {
  LawFinding finding{LawFinding::pass};
  LawFindingReason reason{};
  std::vector<FoundLaw> laws{};  ///< strongest first; the first is found even where it is not believed
  /// Of the search in what is left after the laws; where that or `left_sigmas` would speak against them, both
  /// are of a fit with them.
  double log10_p_left{0};
  std::string left_on{};  ///< an axis on which more scatters than noise, after the laws
  double left_sigmas{0};
  std::size_t poses{0}, searched{0};  ///< of the run, and those that the search took
  std::size_t formulas{0}, hypotheses{0};
  std::string grammar_hash{};
  double questions{0};  ///< independent ones, by draws
  int draws{0};
  double chi2{0}, dof{0};
  double noise_nT{0}, residual_nT{0};
  double rho{0};             ///< correlation from pose to pose in force
  bool may_be_drift{false};  ///< law_finding.h
  bool wanders{false};       ///< the offsets wander, as far as the tests of the library can tell
  struct After {
    double residual_nT{0};
    std::optional<double> unseen_before_nT{}, unseen_after_nT{};
  };
  std::optional<After> after{};  ///< of a fit with the first formula of each law

  /// LAW or LAW-SET: formulas leave nothing.
  [[nodiscard]] bool accounts_for_everything() const {
    return finding == LawFinding::law || finding == LawFinding::law_set;
  }
};

}  // namespace mgtd::calib::discovery
