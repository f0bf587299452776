// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "calib/linear/parts.h"
#include "tests/blind/answer_file.h"

/// A campaign asks about many runs of one kind, each with a seed of its own.
namespace mgtd::calib::testing {

/// Answers in the order of their seeds, made on two processors by `make(seed)`; those that the file has are
/// not made again. `made(seed, answer)` sees each new one, in that order, once it is in the file.
template <class Answer, class Make, class Made>
std::vector<Answer> campaign(AnswerFile<Answer>& file, const std::string& kind, std::uint64_t first_seed,
                             int count, const Make& make, const Made& made) {
  constexpr std::size_t kTogether = 8;  // an interruption loses so many at most
  std::vector<std::uint64_t> seeds, missing;
  for (int i = 0; i < count; ++i) seeds.push_back(first_seed + static_cast<std::uint64_t>(i));
  for (const std::uint64_t seed : seeds)
    if (file.find(kind, seed) == nullptr) missing.push_back(seed);
  for (std::size_t from = 0; from < missing.size(); from += kTogether) {
    std::vector<Answer> answers(std::min(kTogether, missing.size() - from));
    linear::for_each_part(answers.size(), [&](std::size_t i) { answers[i] = make(missing[from + i]); });
    for (std::size_t i = 0; i < answers.size(); ++i) {
      file.add(kind, missing[from + i], answers[i]);
      made(missing[from + i], answers[i]);
    }
  }
  std::vector<Answer> out;
  for (const std::uint64_t seed : seeds) out.push_back(*file.find(kind, seed));
  return out;
}

}  // namespace mgtd::calib::testing
