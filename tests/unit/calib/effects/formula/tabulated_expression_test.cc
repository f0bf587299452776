// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/formula/tabulated_expression.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace mgtd::calib::effects::formula {
namespace {

std::optional<Eigen::VectorXd> counted(const std::string& name) {
  if (name != "x") return std::nullopt;
  return Eigen::VectorXd::LinSpaced(3, 0, 2);
}

TEST(TabulatedExpression, IsComputedAtEveryPoint) {
  const auto values = TabulatedExpression(3, counted)("x*x + 0.5");
  ASSERT_TRUE(values) << values.error().text();
  EXPECT_EQ(*values, Eigen::Vector3d(0.5, 1.5, 4.5));
}

TEST(TabulatedExpression, ANameWithoutValuesIsRefused) {
  const auto values = TabulatedExpression(3, counted)("2*y");
  ASSERT_FALSE(values);
  EXPECT_NE(values.error().text().find("no 'y'"), std::string::npos) << values.error().text();
}

// For the thread sanitizer: all parsers share one locale, in which the first number read fills a cache.
TEST(TabulatedExpression, NumbersAreReadOnSeveralThreadsAtOnce) {
  std::vector<double> last(4);
  std::vector<std::thread> threads;
  for (double& out : last)
    threads.emplace_back([&out] {
      if (const auto values = TabulatedExpression(3, counted)("0.25*x + 1.5")) out = (*values)[2];
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(last, std::vector<double>(4, 2.0));
}

}  // namespace
}  // namespace mgtd::calib::effects::formula
