// SPDX-License-Identifier: Apache-2.0
#include "calib/linear/blas_threads.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <iterator>

#include "calib/linear/product.h"

namespace mgtd::calib::linear {
namespace {

std::ptrdiff_t threads_of_this_process() {
  using Tasks = std::filesystem::directory_iterator;
  return std::distance(Tasks("/proc/self/task"), Tasks());
}

#if defined(__SANITIZE_THREAD__)
constexpr bool kOneMore = true;
#elif defined(__has_feature)
constexpr bool kOneMore = __has_feature(thread_sanitizer);
#else
constexpr bool kOneMore = false;
#endif

/// Of this program, which has ended those of the library before main().
TEST(BlasThreads, AreNoneBeforeAndAfterALargeProduct) {
  const std::ptrdiff_t own = kOneMore ? 2 : 1;  // that of the sanitizer
  EXPECT_EQ(threads_of_this_process(), own);
  const Eigen::MatrixXd A = Eigen::MatrixXd::Constant(600, 600, 0.5);
  EXPECT_DOUBLE_EQ(gram(A)(0, 0), 150);
  EXPECT_EQ(threads_of_this_process(), own);
}

}  // namespace
}  // namespace mgtd::calib::linear
