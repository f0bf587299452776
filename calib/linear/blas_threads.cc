// SPDX-License-Identifier: Apache-2.0
#include "calib/linear/blas_threads.h"

#include <cblas.h>

// In every OpenBLAS that has threads of its own, and in no header of it.
extern "C" int blas_thread_shutdown_() __attribute__((weak));

namespace mgtd::calib::linear {

void end_blas_threads() {
  openblas_set_num_threads(1);
  if (openblas_get_parallel() == OPENBLAS_THREAD && blas_thread_shutdown_ != nullptr) blas_thread_shutdown_();
}

}  // namespace mgtd::calib::linear
