// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/sentence.h"

#include <gmock/gmock.h>

namespace mgtd::calib {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(Sentence, SaysWhatWasLeftOut) {
  ExplainReport report;
  EXPECT_THAT(sentence(report), Not(HasSubstr("left out")));
  report.outliers = {{5, "s4.z", -49.98, "nT", 107}};
  EXPECT_THAT(sentence(report),
              HasSubstr("One observation that the others contradict is left out, in pose 5"));
  report.outliers.push_back({9, "scalar", 3, "nT", 20});
  report.outliers.push_back({9, "s1.x", 30, "nT", 20});
  EXPECT_THAT(sentence(report),
              HasSubstr("3 observations that the others contradict are left out, in pose 5, 9"));
}

}  // namespace
}  // namespace mgtd::calib
