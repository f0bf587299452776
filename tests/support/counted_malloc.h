// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdlib>

/// Replaces malloc, which operator new and Eigen both end in, in the whole test program by one that counts.
/// To be included by one file of a program. The sanitizers bring their own malloc, and nothing is counted.
#if defined(__GLIBC__) && !defined(MGTD_SANITIZED)
#define MGTD_COUNTS_ALLOCATIONS 1
#else
#define MGTD_COUNTS_ALLOCATIONS 0
#endif

namespace mgtd::testing {

/// Of this thread.
inline thread_local std::size_t allocations = 0;

}  // namespace mgtd::testing

#if MGTD_COUNTS_ALLOCATIONS
extern "C" void* __libc_malloc(std::size_t bytes);
extern "C" void* malloc(std::size_t bytes) noexcept {  // NOLINT(misc-definitions-in-headers)
  ++mgtd::testing::allocations;
  return __libc_malloc(bytes);
}
#endif
