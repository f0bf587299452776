// SPDX-License-Identifier: Apache-2.0
#include "calib/report/noise_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calib/report/reference_text.h"
#include "calib/report/wandering_text.h"

namespace mgtd::calib::report {

namespace {

/// Pairs of visits to one attitude that tell noise of `factor` times the dwells' from noise of the dwells by
/// three standard deviations: a variance from nu degrees of freedom is known to sqrt(2/nu) of itself.
int revisits_that_tell(double factor) {
  constexpr double kSigmas = 3, kFreedomOfPair = 8;  // noise.h
  constexpr int kFewest = 3;
  const double share = 1 - 1 / (factor * factor);
  return std::max(kFewest,
                  static_cast<int>(std::ceil(2 * kSigmas * kSigmas / (share * share) / kFreedomOfPair)));
}

std::string beyond_dwells_text(const criticism::tests::NoiseModel& noise) {
  const double factor = noise.beyond_dwells;
  if (noise.vector && noise.vector->more())
    return fmt::format("the noise is {:.2g} times what the spread within the dwells says: {}", factor,
                       reference_scatter_remark(*noise.vector));
  std::string out = fmt::format(
      "the noise is {:.2g} times what the spread within the dwells says, in most channels and without a "
      "shape: successive samples are correlated (as if there were {:.2g} times fewer), or it arises between "
      "the dwells",
      factor, factor * factor);
  if (noise.revisits) return out + ". Give n_eff";
  return out +
         fmt::format(". Give n_eff, or visit {} attitudes twice, which tells it from a model that is wrong",
                     revisits_that_tell(factor));
}

/// A slow law that is in no library makes an offset move as a walk does.
std::string walk_or_law(const fit::joint::WanderingEstimate& wandering) {
  if (wandering.where.front() == "all") return {};
  return ". A slow law that is in no library looks the same in one run: measure again on another day, a law "
         "of time or temperature comes back, a walk does not";
}

}  // namespace

std::string noise_of_tests(const criticism::tests::NoiseModel& noise) {
  const criticism::tests::NoiseReference& n = noise.reference;
  if (noise.wandering.any()) {
    return fmt::format(
        "{}, is part of the noise{}: a law is named only where it fits better than that{}",
        wandering_text(noise.wandering),
        noise.beyond_dwells > 1
            ? fmt::format(", beside white noise {:.2g} times what the spread within the dwells says",
                          noise.beyond_dwells)
            : "",
        walk_or_law(noise.wandering));
  }
  if (noise.beyond_dwells > 1) return beyond_dwells_text(noise);
  if (!noise.known)
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

}  // namespace mgtd::calib::report
