// SPDX-License-Identifier: Apache-2.0
#include "calib/design/hypothesis_distance.h"

#include <gmock/gmock.h>

#include <random>

namespace mgtd::calib::design {
namespace {

using ::testing::ElementsAre;

Eigen::MatrixXd drawn(Eigen::Index rows, Eigen::Index columns, std::uint64_t seed) {
  std::mt19937_64 rng(seed);
  std::normal_distribution<double> normal;
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return normal(rng); });
}

/// Two parameters of the calibration, and three descriptions of one column.
std::vector<Described> three() {
  std::vector<Described> out(3);
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i].first = 2 + static_cast<Eigen::Index>(i), out[i].count = 1;
    out[i].size = Eigen::VectorXd::Constant(1, 1.5);
  }
  return out;
}
const std::vector<HypothesisPair> kPairs{{0, 1}, {0, 2}};

TEST(HypothesisDistance, RowsThatAreAddedCountAsThoseThatWereThere) {
  const Eigen::MatrixXd all = drawn(60, 5, 1);
  HypothesisDistance distance(all.topRows(40), 2, three(), kPairs);
  const HypothesisDistance whole(all, 2, three(), kPairs);
  const double before = distance.lambda(1), gain = distance.gain(1, all.middleRows(40, 12));
  distance.add(all.middleRows(40, 12));
  EXPECT_NEAR(distance.lambda(1), before + gain, 1e-9);
  distance.add(all.bottomRows(8));
  for (std::size_t pair : {0U, 1U})
    EXPECT_NEAR(distance.lambda(pair), whole.lambda(pair), 1e-6 * whole.lambda(pair));
}

/// Rows of one pose: nothing but description 0 where it differs from 1 by `first`, from 2 by `second`.
PossiblePose pose(double first, double second, double minutes) {
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(1, 5);
  rows(0, 2) = 1, rows(0, 3) = 1 - first, rows(0, 4) = 1 - second;
  return {.rows = rows, .minutes = minutes};
}

/// All three alike on these poses.
Eigen::MatrixXd alike() {
  Eigen::MatrixXd out = drawn(40, 5, 2);
  out.col(3) = out.col(2), out.col(4) = out.col(2);
  return out;
}

TEST(HypothesisDistance, ThePoseThatTellsMostAMinuteIsTaken) {
  const std::vector<std::vector<PossiblePose>> groups{{pose(0, 0, 1), pose(1, 1, 1), pose(1.2, 1.2, 9)}};
  EXPECT_THAT(placed(HypothesisDistance(alike(), 2, three(), kPairs), groups), ElementsAre(1U));
}

TEST(HypothesisDistance, ThePairThatIsWorstByThenDecides) {
  const std::vector<PossiblePose> group{pose(1, 0, 1), pose(0, 1, 1)};
  const auto which = placed(HypothesisDistance(alike(), 2, three(), kPairs), {group, group});
  EXPECT_NE(which[0], which[1]) << "after one pair is helped it is the other's turn";
}

TEST(HypothesisDistance, WhereNothingHelpsTheWorstPairTheNextIsServed) {
  // 0 and 1 stay the same whatever is measured.
  const std::vector<PossiblePose> group{pose(0, 0, 1), pose(0, 1, 1)};
  EXPECT_THAT(placed(HypothesisDistance(alike(), 2, three(), kPairs), {group}), ElementsAre(1U));
}

}  // namespace
}  // namespace mgtd::calib::design
