// SPDX-License-Identifier: Apache-2.0
#include "calib/report/explain_json.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace mgtd::calib::report {
namespace {

/// A number stands for a size alone: what would be seen at none is said in words.
TEST(ExplainJson, AnEffectThatWouldBeSeenAtNoSizeHasNone) {
  criticism::search::ExplainReport report;
  report.detectable = {{"axis.cubic", "s1.y", 0.25, "nT"},
                       {"axis.offset.temperature", "s3.z", criticism::tests::kAtNoSize, "nT/degC"}};
  const nlohmann::json sizes = to_json(report).at("detectable_above");
  EXPECT_EQ(sizes.at(0).at("value"), 0.25);
  EXPECT_EQ(sizes.at(0).at("text"), "0.25 nT (s1.y)");
  EXPECT_TRUE(sizes.at(1).at("value").is_null());
  EXPECT_EQ(sizes.at(1).at("text"), "at no size: what is in the model takes it up");
}

}  // namespace
}  // namespace mgtd::calib::report
