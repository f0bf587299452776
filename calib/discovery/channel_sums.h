// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <memory>
#include <random>
#include <vector>

#include "calib/criticism/tests/residual.h"

/// ChannelSums holds everything that a search for laws needs of a fit, in as many dimensions as there are
/// poses.
///
/// A law adds g(k) to what channel c reads at pose k. With Z_c the projected columns of one unit at each pose
/// (nuisances and the model's own parameters taken out, poses uncorrelated) its signature is Z_c g, and with
/// r the residual
///
///     s_c = Z_c' r                score of g       g' s_c
///     G_cd = Z_c' Z_d             product of two   g' G_cd h
///
/// Z_c itself is never made: with W the whitener over the residual's unit, E_c the rows of one unit at each
/// pose and B the basis of the model's parameters (projection.h), G_cd = h_cd - U_c' U_d, where h_cd =
/// E_c' W'W E_d and U_c = B' W E_c is what those parameters can take. Where the noise is uncorrelated from
/// pose to pose h_cd is diagonal and held, else W is applied whenever h_cd is asked for.
///
/// Channels 0 .. 3N-1 are those of the readings; behind them stand five components of a gradient of the
/// site's field (kGradient), where the poses have table angles.
namespace mgtd::calib::discovery {

inline constexpr int kGradient = 5;  ///< components Gxx, Gyy, Gxy, Gxz, Gyz

/// Of the length of a formula less its mean: what is left of an absorbed one.
inline constexpr double kAbsorbedShare = 2e-4;
/// Of the whole length, below which what is left is rounding.
inline constexpr double kRounding = 1e-6;

/// One over the length that columns have left after projection; zero for absorbed ones, that have less than
/// `share` left. Squares of lengths: what is left, what there was without the mean, and all of it.
[[nodiscard]] double one_over_length_left(double left2, double about_mean2, double whole2, double share);
[[nodiscard]] Eigen::VectorXd one_over_length_left(const Eigen::VectorXd& left2,
                                                   const Eigen::VectorXd& about_mean2,
                                                   const Eigen::VectorXd& whole2, double share);

/// Combinations of unit columns that are orthonormal after projection, one a column. `left`: their products
/// after projection, `before`: without it, lower triangles. Where `share` is that of noisy readings a
/// combination that has less of its length left is absorbed, though each of its columns has more.
[[nodiscard]] Eigen::MatrixXd combinations(const Eigen::MatrixXd& left, const Eigen::MatrixXd& before,
                                           double share);

/// By channel; columns are draws or one residual.
using Scores = std::vector<Eigen::MatrixXd>;

/// A law with its coefficients: nT at each pose of the channels that it acts on; an empty vector elsewhere.
using LawOnChannels = std::vector<Eigen::VectorXd>;

/// Rows of one unit of each component of the gradient, as LinearRows; no column without table angles or for
/// one sensor.
[[nodiscard]] Eigen::MatrixXd gradient_rows(const fit::joint::JointProblem& problem,
                                            const fit::joint::JointState& state);

/// Rows of a law, as LinearRows. `of_gradient`: gradient_rows().
[[nodiscard]] Eigen::VectorXd law_rows(const LawOnChannels& law, const fit::joint::JointProblem& problem,
                                       const Eigen::MatrixXd& of_gradient);

class ChannelSums {
 public:
  ChannelSums(const fit::joint::JointFit& fit, const criticism::tests::Residual& residual);

  [[nodiscard]] Eigen::Index poses() const { return poses_; }
  /// Of the readings.
  [[nodiscard]] int channels() const { return channels_; }
  [[nodiscard]] bool has_gradient() const { return total_ > channels_; }
  /// Share of its length below which a projected formula says nothing: kAbsorbedShare, and more where the
  /// readings are so noisy that what is left of a formula of them is their noise (Residual::absorbed).
  [[nodiscard]] double absorbed_share() const { return absorbed_share_; }
  /// With the components of the gradient.
  [[nodiscard]] int total() const { return total_; }

  [[nodiscard]] Eigen::VectorXd score(int channel) const {
    return scores_[static_cast<std::size_t>(channel)].col(0);
  }
  /// The noise lasts from pose to pose.
  [[nodiscard]] bool correlated() const { return correlated_; }
  /// W E_c G: columns of `g` on channel c as they are before projection; h_cd is their product with those on
  /// channel d. Whitener::rows_per_pose() rows for each pose.
  [[nodiscard]] Eigen::MatrixXd whitened(int c, const Eigen::MatrixXd& g) const;
  /// h_cd G.
  [[nodiscard]] Eigen::MatrixXd before_projection(int c, int d, const Eigen::MatrixXd& g) const;
  /// g_c' h_cd g_d of the columns of several channels, side by side in the order of `channels`.
  [[nodiscard]] Eigen::MatrixXd before_projection(const std::vector<int>& channels,
                                                  const std::vector<Eigen::MatrixXd>& g) const;
  /// h_cc 1: of a constant.
  [[nodiscard]] const Eigen::VectorXd& before_of_one(int channel) const {
    return before_of_one_[static_cast<std::size_t>(channel)];
  }
  /// U_c G: what the model's own parameters can take, and below it what laws take that were taken out.
  [[nodiscard]] Eigen::MatrixXd taken_up(int c, const Eigen::MatrixXd& g) const;
  [[nodiscard]] Eigen::MatrixXd taken_up_by_model(int c, const Eigen::MatrixXd& g) const;
  [[nodiscard]] Eigen::MatrixXd taken_up_by_laws(int c, const Eigen::MatrixXd& g) const;
  /// G_cd: poses x poses.
  [[nodiscard]] Eigen::MatrixXd products(int c, int d) const;
  /// G_cd G.
  [[nodiscard]] Eigen::MatrixXd product(int c, int d, const Eigen::MatrixXd& g) const;

  /// Product of the signatures of two laws.
  [[nodiscard]] double product(const LawOnChannels& a, const LawOnChannels& b) const;
  /// Of the signature of a law with the residual.
  [[nodiscard]] double by_residual(const LawOnChannels& a) const;
  /// A signature with every channel's unit columns: Z_c' z, by channel.
  [[nodiscard]] std::vector<Eigen::VectorXd> by_channel(const LawOnChannels& a) const;

  /// Takes the direction of a law out of everything: from now on it counts as a parameter of the model.
  /// Nothing happens where the model takes up the law whole.
  void take_out(const LawOnChannels& law);

  /// `count` draws of noise, a column each.
  [[nodiscard]] Eigen::MatrixXd noise(Eigen::Index count, std::mt19937_64& random) const;
  /// Scores of draws of noise, in the columns of each channel.
  [[nodiscard]] Scores scores_of(Eigen::MatrixXd noise) const;

  /// G_cc as a whole: the mean and the variance of |s_c|^2 where s_c is noise are its trace and twice its
  /// squares.
  struct Moments {
    double trace{0}, squares{0};
  };
  [[nodiscard]] Moments moments(int channel) const;

 private:
  /// What stays as it is when a law is taken out; copies share it.
  struct Linearised {
    std::shared_ptr<const criticism::tests::Projection> projection;
    double unit;           ///< Residual::unit
    Eigen::MatrixXd rows;  ///< E_c: of one unit on each channel, at every pose
    int channels;
    /// Diagonals of h_cd, d >= c, where the noise is uncorrelated; else empty.
    std::vector<std::vector<Eigen::VectorXd>> before;
    /// h_cc of a single sensor, where the noise is correlated: every round asks for those of all its axes.
    std::vector<Eigen::MatrixXd> each_pose;

    [[nodiscard]] const Eigen::VectorXd& before_of(int c, int d) const;
    /// E_c G.
    [[nodiscard]] Eigen::MatrixXd spread(int c, const Eigen::MatrixXd& g) const;
    /// E_c' X, X rows as in LinearRows.
    [[nodiscard]] Eigen::MatrixXd on_channel(int c, const Eigen::MatrixXd& X) const;
    /// E_c' W' X of every channel, X as the whitener gives rows.
    [[nodiscard]] Scores by_channel(const Eigen::MatrixXd& X) const;
    void set_before();
    void set_each_pose();
  };

  Eigen::Index poses_;
  int channels_, total_;
  bool correlated_;
  double absorbed_share_;
  std::shared_ptr<const Linearised> fit_;
  std::vector<Eigen::VectorXd> before_of_one_;
  std::vector<Eigen::MatrixXd> taken_;  ///< U_c
  Scores scores_;
  struct TakenOut {
    LawOnChannels law;  ///< of unit length
    std::vector<Eigen::VectorXd> by_channel;
  };
  std::vector<TakenOut> taken_out_;
};

}  // namespace mgtd::calib::discovery
