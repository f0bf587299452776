// SPDX-License-Identifier: Apache-2.0
#pragma once

/// end_blas_threads() makes OpenBLAS multiply on the thread that calls it, and on no other.
///
/// Where the library is built with threads it starts one for each processor when it is loaded. They look for
/// work for a while before they sleep, which takes processor time from the parts of parts.h, and digits would
/// depend on how many there are.
namespace mgtd::calib::linear {

/// For the start of a program, before the first product. Of a library that is built without threads, or that
/// does not let them end, nothing but the number to use is changed.
void end_blas_threads();

}  // namespace mgtd::calib::linear
