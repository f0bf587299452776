// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "calib/report/figures/figure.h"

/// candidates_figure() shows what could be missing from the model: the size of each candidate in units of its
/// own uncertainty, with those that these poses cannot tell apart joined by a bracket, and what could not be
/// tested at all.
namespace mgtd::calib::report::figures {

struct Candidate {
  std::string effect{}, where{};
  double d{0};
  std::string p{}, size{};                   ///< as text, with unit
  std::vector<std::string> could_also_be{};  ///< names among the other candidates, or of others
  bool named{false};
  bool plausible{true};  ///< of a size that occurs
};

struct CandidatesValues {
  std::vector<Candidate> candidates{};  ///< largest first
  std::size_t tried{0};                 ///< all that were tested
  double seen_d{8};                     ///< seen in 99 of 100 runs
  std::vector<std::string> untestable{};
};

[[nodiscard]] Figure candidates_figure(const CandidatesValues& values);

}  // namespace mgtd::calib::report::figures
