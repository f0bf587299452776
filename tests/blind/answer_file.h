// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <fstream>
#include <map>
#include <string>
#include <utility>

#include "tests/blind/real_answer.h"

/// An answer file keeps what the runs of a campaign answered, one JSON line each, on disk before the next run
/// begins: a campaign of many hours can be interrupted, and goes on with the next call. Delete the file when
/// the program changes.
namespace mgtd::calib::testing {

class AnswerFile {
 public:
  /// Reads what is there; without a path nothing is kept. Throws std::runtime_error with the line that is no
  /// answer; the last one, cut by an interruption, is left away.
  explicit AnswerFile(const std::string& path);

  /// Null: this run has not been made.
  [[nodiscard]] const RealAnswer* find(const std::string& kind, std::uint64_t seed) const;
  void add(const std::string& kind, std::uint64_t seed, const RealAnswer& answer);

 private:
  std::map<std::pair<std::string, std::uint64_t>, RealAnswer> answers_;
  std::ofstream out_;
};

}  // namespace mgtd::calib::testing
