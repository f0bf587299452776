// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "calib/discovery/discovery_report.h"
#include "tests/blind/campaign.h"
#include "tests/discovery/unknown_law.h"

/// Asks discover about runs in which the truth is known, and keeps what it said.
namespace mgtd::calib::testing {

inline constexpr double kNoise_nT = 0.05;

/// What was said of one run.
struct Answer {
  discovery::LawFinding finding{discovery::LawFinding::pass};
  double log10_p{0}, P{0};
  bool found{false};      ///< something stands out from noise
  bool place{false};      ///< on s3.z, as is true
  bool covariate{false};  ///< of what it is a function
  bool first{false};      ///< the true formula leads
  bool alike{false};      ///< or one that these poses do not tell from it
  bool in_set{false};     ///< the true formula is in the 99 % set
  std::size_t set{0};     ///< formulas in that
  /// Of the error that the law makes on poses that no fit has seen, the share that the leading formula takes
  /// away; empty where nothing was found.
  std::optional<double> gain{};
  std::string formula{}, reason{};
  std::vector<std::string> effects{};  ///< of the leading formula, as --with reads them
};

/// `law`: nullptr where there is no true formula. Throws where a fit is refused.
[[nodiscard]] Answer ask(const PoseTable& table, const UnknownLaw* law, int draws);

/// A law on s3.z of which the calibration leaves `d` standard deviations, in a run with unseen poses.
[[nodiscard]] Answer ask_of_law(const UnknownLaw& law, Course course, double d, std::uint64_t seed,
                                int draws);
/// The same without a true formula, and without a look at unseen poses.
[[nodiscard]] Answer ask_of_lawless(const UnknownLaw& law, double d, std::uint64_t seed, int draws);

/// As a line of an answer file.
void to_json(nlohmann::json& j, const Answer& answer);
void from_json(const nlohmann::json& j, Answer& answer);

/// Answers of one cell of the page.
template <class Make>
std::vector<Answer> cell(AnswerFile<Answer>& file, const std::string& kind, std::uint64_t first_seed,
                         int count, const Make& make) {
  return campaign(file, kind, first_seed, count, make, [](std::uint64_t, const Answer&) {});
}

template <class Is>
int count_of(const std::vector<Answer>& all, const Is& is) {
  return static_cast<int>(std::count_if(all.begin(), all.end(), is));
}

}  // namespace mgtd::calib::testing
