// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "calib/criticism/search/explain.h"
#include "tests/blind/hidden_law.h"

/// The blind benchmark: a law is hidden, explain is asked, the answers are counted.
namespace mgtd::calib::testing {

/// Counts of one cell.
struct Answers {
  int runs{0}, refused{0};
  std::map<criticism::search::Finding, int> findings;
  int detected{0};      ///< any verdict but PASS
  int named_first{0};   ///< the first name is the right one, of those detected
  int in_set{0};        ///< the right name is among those that are named or possible
  int wrong_single{0};  ///< EXPLAINED by something else
  int wanders{0};       ///< PASS, with an offset that wanders
  /// Sum over detections of the probability that ranking by likelihood puts the right one of two laws first,
  /// the first name and the one that is hardest to tell from it.
  double told_at_best{0};
  std::map<std::string, int> first;
  std::vector<int> set_sizes;  ///< of each detection
  int advised{0};              ///< the advice is a change of the field

  [[nodiscard]] int of(criticism::search::Finding finding) const;
  Answers& operator+=(const Answers& other);
};

/// Asks explain about one run and counts the answer; `truth` is the name of what is hidden, "" of nothing.
void ask(const PoseTable& table, const std::string& truth, const criticism::search::ExplainOptions& options,
         Answers& out);

[[nodiscard]] Answers clean(const HiddenRun& run, int runs, std::uint64_t seed);
/// A law hidden on axes in turn, as large as `d` of its own uncertainties in this design.
/// `taken_out`: the library does not hold it.
[[nodiscard]] Answers hidden(const HiddenLaw& law, double d, int runs, std::uint64_t seed,
                             bool taken_out = false);

/// Standard deviation of the coefficient of a law on one axis with everything else free (Cramer-Rao); of the
/// law's own signature, so that it also holds for what is in no library.
[[nodiscard]] double crb_of(const HiddenLaw& law, int sensor, int axis, std::uint64_t seed);

/// Two laws of different names on different axes, each of size `d`; improve adds what it finds.
struct TwoAnswers {
  int runs{0};
  int both_added{0};   ///< both names were added
  int both_found{0};   ///< added or declared possible in the place of what was added
  int wrong_added{0};  ///< a name that is neither hidden nor ambiguous with what is
  std::map<std::string, int> missed;
};
[[nodiscard]] TwoAnswers two_hidden(double d, int runs, std::uint64_t seed);

/// 95 % interval of a proportion (Wilson), percent.
struct Proportion {
  double percent{0}, low{0}, high{0};
};
[[nodiscard]] Proportion proportion(int hits, int of);

}  // namespace mgtd::calib::testing
