// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>

#include "calib/discovery/channel_sums.h"
#include "calib/discovery/grammar.h"
#include "calib/discovery/place.h"

/// Scores every formula of a grammar at every place where it can act.
///
/// With z the projected columns of a formula at a place, U an orthonormal basis of their span and r the
/// residual, S = |U' r|^2 is the fall of chi-square that the formula would bring, chi-square with as many
/// degrees of freedom as U has columns where nothing is there. A formula of which less than kAbsorbedShare of
/// its length is left by the projection is a parameter of the calibration already, and is not asked about.
namespace mgtd::calib::discovery {

/// The values of every formula on every channel: they stay the same from one residual to the next.
class FormulaValues {
 public:
  /// Refuses a grammar that does not fit the inputs.
  [[nodiscard]] static Result<FormulaValues> of(const Grammar& grammar, LawInputs& inputs);

  struct Member {
    std::size_t family{0}, inner{0};
    Eigen::Index first{0}, count{0};  ///< columns
  };
  [[nodiscard]] const std::vector<Member>& members() const { return members_; }
  [[nodiscard]] const Eigen::MatrixXd& on(int channel) const {
    return columns_[static_cast<std::size_t>(channel)];
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

struct Tried {
  std::size_t member{0};
  Place place;
  int k{0};  ///< coefficients that these poses tell apart
  double S{0};
};

class LawSearch {
 public:
  /// Both must outlive this.
  LawSearch(const FormulaValues& values, const ChannelSums& sums);

  /// Every question, with its score.
  [[nodiscard]] std::vector<Tried> scores() const;

  /// The largest S of draws of noise, by kind of place and k.
  struct Largest {
    Place::Kind kind{Place::Kind::axis};
    int k{0}, alike{1}, axes{1};
    Eigen::ArrayXf S;  ///< by draw
  };
  [[nodiscard]] std::vector<Largest> largest(const Scores& draws) const;

 private:
  /// Formulas on one channel: columns of each orthonormal after projection, as many as count where none is
  /// absorbed, then zeros.
  struct OnChannel {
    Eigen::MatrixXd columns, taken;  ///< and what the model's parameters take of them
    std::vector<int> rank;           ///< by member
  };
  /// Orthonormal combinations of a formula's columns on the channels of a place.
  struct Combination {
    std::size_t member{0};
    Eigen::MatrixXd basis;  ///< columns of all channels one below the other x rank
  };
  struct Wide {
    Place place;
    std::vector<Combination> combinations;
  };

  [[nodiscard]] OnChannel on_channel(int channel) const;
  [[nodiscard]] Wide wide(const Place& place) const;
  /// Scores of the columns of a channel: a row a column.
  template <class Scalar>
  [[nodiscard]] std::vector<Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>> column_scores(
      const Scores& scores) const;

  const FormulaValues& values_;
  const ChannelSums& sums_;
  std::vector<OnChannel> channels_;
  std::vector<Wide> wide_;
};

}  // namespace mgtd::calib::discovery
