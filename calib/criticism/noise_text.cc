// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/noise_text.h"

#include <fmt/format.h>

#include <cmath>

#include "calib/fit/wandering_text.h"

namespace mgtd::calib {

namespace {

std::string beyond_dwells_text(double factor) {
  if (!(factor > 1)) return {};
  return fmt::format(
      "the noise is {:.2g} times what the spread within the dwells says, in most channels and without a "
      "shape: successive samples are correlated (as if there were {:.2g} times fewer), or it arises between "
      "the dwells. Give n_eff, or revisit some attitudes to measure it",
      factor, factor * factor);
}

}  // namespace

std::string noise_of_tests(const NoiseModel& noise) {
  const NoiseReference& n = noise.reference;
  if (noise.wandering.any()) {
    return fmt::format(
        "{}, is part of the noise{}: a law is named only where it fits better than that",
        wandering_text(noise.wandering),
        noise.beyond_dwells > 1
            ? fmt::format(", beside white noise {:.2g} times what the spread within the dwells says",
                          noise.beyond_dwells)
            : "");
  }
  if (noise.beyond_dwells > 1) return beyond_dwells_text(noise.beyond_dwells);
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
