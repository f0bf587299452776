// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

/// A GapLine turns GAP objects that follow each other into one line for a person. A sensor that is away sends
/// one a second; what matters is how many samples are missing by now, between which, and why.
namespace mgtd::daemon::cli {

class GapLine {
 public:
  void add(std::uint64_t from_seq, std::uint64_t to_seq, const std::string& why);
  void clear() { *this = {}; }
  [[nodiscard]] bool empty() const { return count_ == 0; }
  /// "gap: 52 samples, 5300 to 5351, are missing: s2: silent, s2: not measuring yet"; where samples between
  /// them are not, "gap: 52 samples of 5300 to 5400 are missing: ...".
  [[nodiscard]] std::string text() const;

 private:
  std::uint64_t from_{0}, to_{0}, count_{0};
  std::vector<std::string> why_;  ///< each once, in their order
};

}  // namespace mgtd::daemon::cli
