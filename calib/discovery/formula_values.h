// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>

#include "calib/discovery/grammar.h"
#include "calib/discovery/place.h"

namespace mgtd::calib::discovery {

/// FormulaValues holds the values of every formula on every channel, which stay the same from one residual to
/// the next.
class FormulaValues {
 public:
  /// Refuses a grammar that does not fit the inputs.
  [[nodiscard]] static Result<FormulaValues> of(const Grammar& grammar, LawInputs& inputs);

  struct Member {
    std::size_t family{0}, inner{0};
    Eigen::Index first{0}, count{0};  ///< columns
  };
  [[nodiscard]] const std::vector<Member>& members() const { return members_; }
  /// On a channel of ChannelSums. A component of the gradient has the values of the first channel: only
  /// formulas that are the same on all act there.
  [[nodiscard]] const Eigen::MatrixXd& on(int channel) const {
    const auto c = static_cast<std::size_t>(channel);
    return columns_[c < columns_.size() ? c : 0];
  }
  [[nodiscard]] const Grammar& grammar() const { return *grammar_; }
  /// The same at some of the poses.
  [[nodiscard]] FormulaValues at(const std::vector<std::size_t>& poses) const;
  /// A family is asked about at a place.
  [[nodiscard]] bool asked(const Family& family, const Place& place) const;

 private:
  explicit FormulaValues(const Grammar& grammar) : grammar_(&grammar) {}

  const Grammar* grammar_;
  std::vector<Member> members_;
  std::vector<Eigen::MatrixXd> columns_;  ///< by channel of the readings: poses x columns
};

}  // namespace mgtd::calib::discovery
