// SPDX-License-Identifier: Apache-2.0
#include "calib/linear/blas_kernels.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace mgtd::calib::linear {
namespace {

constexpr VectorUnits kOld{}, kAvx2{.avx2_and_fma = true}, kAvx512{.avx2_and_fma = true, .avx512 = true};

TEST(BlasKernels, AreChosenAnewOnlyForAProcessorThatTheLibraryTookForAnOldOne) {
  EXPECT_EQ(kernels_instead("Prescott", nullptr, kAvx512), "SkylakeX");
  EXPECT_EQ(kernels_instead("Prescott", nullptr, kAvx2), "Haswell");
  EXPECT_EQ(kernels_instead("Prescott", nullptr, kOld), std::nullopt) << "it may be one of 2004";
  for (const char* known : {"Haswell", "Zen", "SkylakeX", "Nehalem"})
    EXPECT_EQ(kernels_instead(known, nullptr, kAvx512), std::nullopt) << known;
}

TEST(BlasKernels, OfTheUsersChoiceStay) {
  EXPECT_EQ(kernels_instead("Prescott", "Prescott", kAvx512), std::nullopt);
  EXPECT_EQ(kernels_instead("Prescott", "", kAvx512), "SkylakeX") << "an empty value chooses nothing";
}

/// Of this program, which has called it before main().
TEST(BlasKernels, InUseAreThoseThatFit) {
  if (std::getenv("OPENBLAS_CORETYPE") != nullptr) GTEST_SKIP() << "OPENBLAS_CORETYPE is set";
  EXPECT_EQ(kernels_instead(kernels_in_use(), nullptr, vector_units()), std::nullopt) << kernels_in_use();
}

}  // namespace
}  // namespace mgtd::calib::linear
