// SPDX-License-Identifier: Apache-2.0
#include "calib/report/described_array.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace mgtd::calib::report {
namespace {

TEST(DescribedArray, TheLimitOfTheClosureIsThatOfItsNumbers) {
  const ArrayDescription cross = described(sensor::Geometry());
  EXPECT_EQ(cross.closure, 4);
  ASSERT_TRUE(cross.closure_limit);
  EXPECT_NEAR(*cross.closure_limit, 18.4668, 1e-3);  // R: qchisq(0.999, 4)
  EXPECT_NEAR(to_json(cross).at("closure_limit").get<double>(), 18.4668, 1e-3);
}

}  // namespace
}  // namespace mgtd::calib::report
