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

TEST(DescribedArray, ArraysOfOneNameAreToldApartByAPlace) {
  const sensor::Geometry three({{0.2, 0, 0}, {-0.2, 0, 0}, {0, 0.2, 0}}),
      moved({{0.2, 0, 0}, {-0.2, 0, 0.000004}, {0, 0.2, 0}});
  const auto [own, other] = names_apart(three, moved);
  EXPECT_EQ(own, "an array of 3 sensors with s2 at (-0.2, 0, 0) m");
  EXPECT_EQ(other, "an array of 3 sensors with s2 at (-0.2, 0, 4e-06) m");
  EXPECT_EQ(names_apart(sensor::Geometry(0.4), three),
            std::pair(std::string("the cross of four sensors, 0.4 m from arm to arm"),
                      std::string("an array of 3 sensors")));
}

}  // namespace
}  // namespace mgtd::calib::report
