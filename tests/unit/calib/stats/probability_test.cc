// SPDX-License-Identifier: Apache-2.0
#include "calib/stats/probability.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace mgtd::calib::stats {
namespace {

TEST(Probability, IsNeverZeroAndNeverAboveOne) {
  EXPECT_EQ(p_text(0), "1");
  EXPECT_EQ(p_text(1e-9), "1");
  EXPECT_EQ(p_text(std::log10(0.034)), "0.034");
  EXPECT_EQ(p_text(std::log10(0.00123)), "0.0012");
  EXPECT_EQ(p_text(std::log10(4e-15)), "4e-15");
  EXPECT_EQ(p_text(std::log10(9.7e-13)), "1e-12") << "ten times a power is the next power";
  EXPECT_EQ(p_text(-702.3), "<1e-30");
  EXPECT_EQ(p_text(-std::numeric_limits<double>::infinity()), "<1e-30") << "an underflowed probability";
}

TEST(Probability, ReadsAsPartOfASentence) {
  EXPECT_EQ(p_phrase(std::log10(0.34)), "p = 0.34");
  EXPECT_EQ(p_phrase(-3.9e7), "p < 1e-30");
}

}  // namespace
}  // namespace mgtd::calib::stats
