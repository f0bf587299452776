// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>

#include "calib/discovery/channel_sums.h"
#include "calib/discovery/formula_products.h"

/// A LawSearch scores every formula of a grammar at every place where it can act.
///
/// With z the projected columns of a formula at a place, U an orthonormal basis of their span and r the
/// residual, S = |U' r|^2 is the fall of chi-square that the formula would bring, chi-square with as many
/// degrees of freedom as U has columns where nothing is there. A formula of which less than kAbsorbedShare of
/// its length is left by the projection is a parameter of the calibration already, and is not asked about.
namespace mgtd::calib::discovery {

struct Tried {
  std::size_t member{0};
  Place place;
  int k{0};  ///< coefficients that these poses tell apart
  double S{0};
};

class LawSearch {
 public:
  /// `products`: of `sums`, or of what it was before laws were taken out. The formulas' values and `sums`
  /// must outlive this.
  LawSearch(const FormulaProducts& products, const ChannelSums& sums);

  /// Every question, with its score.
  [[nodiscard]] std::vector<Tried> scores() const;

  /// By channel of ChannelSums: what combinations of a formula's columns have unit length after projection,
  /// as many as it has, at the places of its columns, then zeros. Whatever size a formula has, single
  /// precision is enough for them.
  [[nodiscard]] std::vector<Eigen::MatrixXf> unit_columns() const;

  /// The largest S of draws of noise, by kind of place and k.
  struct Largest {
    Place::Kind kind{Place::Kind::axis};
    int k{0}, alike{1}, axes{1};
    Eigen::ArrayXf S;  ///< by draw
  };
  [[nodiscard]] std::vector<Largest> largest(const Scores& draws,
                                             const std::vector<Eigen::MatrixXf>& unit_columns) const;

 private:
  /// Formulas on one channel.
  struct OnChannel {
    /// By member: combinations of its columns, orthonormal after projection.
    std::vector<Eigen::MatrixXd> basis;
    Eigen::MatrixXd by_laws;  ///< what laws that were taken out take of the columns
    [[nodiscard]] int rank(std::size_t member) const { return static_cast<int>(basis[member].cols()); }
  };
  /// Combinations of a formula's columns on all channels of a place, orthonormal after projection.
  struct Combination {
    std::size_t member{0};
    Eigen::MatrixXd basis;  ///< of the unit columns of all channels, one below the other x rank
  };
  struct Wide {
    Place place;
    std::vector<Combination> combinations;
  };
  [[nodiscard]] OnChannel on_channel(const FormulaProducts& products, int channel) const;
  /// A column of `by_laws` for each of the values.
  [[nodiscard]] Eigen::MatrixXd basis_on(const FormulaProducts& products, std::size_t member, int channel,
                                         const Eigen::MatrixXd& by_laws) const;
  [[nodiscard]] Wide wide(const FormulaProducts& products, const Place& place) const;
  const FormulaValues& values_;
  const ChannelSums& sums_;
  std::vector<OnChannel> channels_;
  std::vector<Wide> wide_;
};

}  // namespace mgtd::calib::discovery
