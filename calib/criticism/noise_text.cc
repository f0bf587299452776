// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/noise_text.h"

#include <fmt/format.h>

#include <cmath>

namespace mgtd::calib {

std::string noise_of_tests(const NoiseModel& noise) {
  const NoiseReference& n = noise.reference;
  if (!noise.told)
    return "a misfit shows by its shape alone: the noise is the residual's own, channel by channel";
  if (noise.correlated()) {
    return fmt::format(
        "what is left is correlated {:.2f} from pose to pose, which no dwell can see: the tests take its own "
        "size for the noise",
        noise.rho);
  }
  if (!n.known)
    return "the residual is far above that noise: the tests ask for its shape and take its own size for the "
           "noise";
  if (!std::isinf(n.nu)) {
    return fmt::format(
        "the {} revisits of an attitude scatter {:.2f} times as much: the tests take that for "
        "the noise",
        noise.revisits ? noise.revisits->pairs : 0, std::sqrt(n.scale2));
  }
  return {};
}

}  // namespace mgtd::calib
