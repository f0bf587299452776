// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string_view>

/// take_fitting_kernels() makes OpenBLAS use the kernels that fit a processor which it does not know. Version
/// 0.3.21, that of Debian 12, tells processors by their model numbers and takes the kernels of Prescott
/// (2004) for one newer than itself: they multiply large matrices at a sixth of the speed of those that it
/// has for AVX-512. Later versions go by what the processor can do. Of a library that is linked statically,
/// or holds kernels of one kind only, nothing is changed.
namespace mgtd::calib::linear {

/// What a processor can do.
struct VectorUnits {
  bool avx2_and_fma{false};
  bool avx512{false};  ///< F, DQ, BW and VL
};
[[nodiscard]] VectorUnits vector_units();

/// The kernels to take instead of those in use; none where the library knew the processor, where its user
/// chose (`chosen`, OPENBLAS_CORETYPE, null or empty: did not), or where nothing fits better.
[[nodiscard]] std::optional<std::string_view> kernels_instead(std::string_view in_use, const char* chosen,
                                                              VectorUnits units);

/// Takes them. For the start of a program, before the first product: no other thread may multiply meanwhile.
void take_fitting_kernels();

/// By the name that the library has for them, "Haswell".
[[nodiscard]] std::string_view kernels_in_use();

}  // namespace mgtd::calib::linear
