// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "calib/discovery/discovery_report.h"
#include "calib/linear/parts.h"
#include "tests/blind/answer_file.h"
#include "tests/discovery/unknown_law.h"

/// Asks discover about runs in which the truth is known, and keeps what it said.
namespace mgtd::calib::testing {

inline constexpr double kNoise_nT = 0.05;

/// What was said of one run.
struct Answer {
  discovery::LawFinding verdict{discovery::LawFinding::pass};
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
[[nodiscard]] Answer ask_of_law(const UnknownLaw& law, double d, std::uint64_t seed, int draws);
/// The same without a true formula, and without a look at unseen poses.
[[nodiscard]] Answer ask_of_lawless(const UnknownLaw& law, double d, std::uint64_t seed, int draws);

/// As a line of an answer file.
void to_json(nlohmann::json& j, const Answer& answer);
void from_json(const nlohmann::json& j, Answer& answer);

/// Answers in the order of their seeds, made on two processors; those that the file has are not made again.
template <class Make>
std::vector<Answer> campaign(AnswerFile<Answer>& file, const std::string& kind, std::uint64_t first_seed,
                             int count, const Make& make) {
  constexpr std::size_t kTogether = 8;  // answers of an interruption that are lost
  std::vector<std::uint64_t> missing;
  for (int i = 0; i < count; ++i)
    if (const std::uint64_t seed = first_seed + static_cast<std::uint64_t>(i);
        file.find(kind, seed) == nullptr)
      missing.push_back(seed);
  for (std::size_t from = 0; from < missing.size(); from += kTogether) {
    std::vector<Answer> made(std::min(kTogether, missing.size() - from));
    linear::for_each_part(made.size(), [&](std::size_t i) { made[i] = make(missing[from + i]); });
    for (std::size_t i = 0; i < made.size(); ++i) file.add(kind, missing[from + i], made[i]);
  }
  std::vector<Answer> out;
  for (int i = 0; i < count; ++i) out.push_back(*file.find(kind, first_seed + static_cast<std::uint64_t>(i)));
  return out;
}

template <class Is>
int count_of(const std::vector<Answer>& all, const Is& is) {
  return static_cast<int>(std::count_if(all.begin(), all.end(), is));
}

}  // namespace mgtd::calib::testing
