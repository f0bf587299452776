// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/covariate.h"

#include <cmath>
#include <numbers>

namespace mgtd::rig {

double toggled(double t_s, double every_s, std::uint64_t pattern) {
  // The finaliser of SplitMix64: neighbouring intervals have nothing in common.
  std::uint64_t z = static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(t_s / every_s))) +
                    pattern * 0x9e3779b97f4a7c15U;
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
  return ((z ^ (z >> 31U)) & 1U) == 0 ? -1 : 1;
}

double Covariate::at(double t_s) const {
  switch (wave) {
    case Wave::toggle:
      return mean + amplitude * toggled(t_s, every_s, pattern);
    case Wave::sine:
      return mean + amplitude * std::sin(2 * std::numbers::pi * t_s / every_s);
    case Wave::ramp:
      return mean + amplitude * t_s / every_s;
  }
  return mean;
}

std::vector<Covariate> on_module(std::vector<Covariate> all) {
  std::erase_if(all, [](const Covariate& c) { return !c.recorded || c.input; });
  return all;
}

std::vector<Covariate> on_digitiser(std::vector<Covariate> all, int slot) {
  std::erase_if(all, [&](const Covariate& c) { return !c.recorded || !c.input || c.input->slot != slot; });
  return all;
}

}  // namespace mgtd::rig
