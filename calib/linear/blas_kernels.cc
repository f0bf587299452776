// SPDX-License-Identifier: Apache-2.0
#include "calib/linear/blas_kernels.h"

#include <cblas.h>

#include <cstdlib>

// In every OpenBLAS that chooses its kernels when it is loaded, and in no header of it.
extern "C" {
void gotoblas_dynamic_quit() __attribute__((weak));
void gotoblas_dynamic_init() __attribute__((weak));
}

namespace mgtd::calib::linear {

VectorUnits vector_units() {
#if defined(__x86_64__)
  return {.avx2_and_fma = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"),
          .avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                    __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl")};
#else
  return {};
#endif
}

std::optional<std::string_view> kernels_instead(std::string_view in_use, const char* chosen,
                                                VectorUnits units) {
  if (in_use != "Prescott" || (chosen != nullptr && *chosen != '\0')) return std::nullopt;
  if (units.avx512) return "SkylakeX";
  if (units.avx2_and_fma) return "Haswell";
  return std::nullopt;
}

void take_fitting_kernels() {
  constexpr const char* kChoice = "OPENBLAS_CORETYPE";
  if (gotoblas_dynamic_quit == nullptr || gotoblas_dynamic_init == nullptr) return;
  const char* const chosen = std::getenv(kChoice);  // NOLINT(concurrency-mt-unsafe)
  const auto kernels = kernels_instead(kernels_in_use(), chosen, vector_units());
  if (!kernels) return;
  setenv(kChoice, kernels->data(), 1);  // NOLINT(concurrency-mt-unsafe)
  gotoblas_dynamic_quit();
  gotoblas_dynamic_init();
  unsetenv(kChoice);  // NOLINT(concurrency-mt-unsafe)
}

std::string_view kernels_in_use() { return openblas_get_corename(); }

}  // namespace mgtd::calib::linear
