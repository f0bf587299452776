// SPDX-License-Identifier: Apache-2.0
#include "tests/blind/real_kind.h"

#include <fmt/format.h>

#include <utility>

#include "tests/blind/fault_kinds.h"
#include "tests/blind/law_kinds.h"
#include "tests/blind/noise_kinds.h"
#include "tests/blind/planted.h"
#include "tests/blind/real_draw.h"

namespace mgtd::calib::testing {
namespace {

/// An effect as large as `d` of its own uncertainties; `effect` draws its shape.
RealKind of_site(const std::string& name, std::vector<std::string> right, double d,
                 Planted (*effect)(Random&)) {
  RealKind out{.name = fmt::format("{}-d{:.0f}", name, d),
               .what = name,
               .must = Must::name,
               .right = std::move(right),
               .parameters = false,
               .d = d};
  out.make = [=](std::uint64_t seed) {
    const Stage stage = full_stage(seed);
    Random random(seed ^ 0x2545f4914f6cdd1dU);
    const Planted planted = sized(stage, effect(random), d, seed).effect;
    return RealRun{planted_run(stage, {planted}, seed), planted_run(stage, {}, seed), stage.scenario.truth,
                   stage.scenario.truth};
  };
  return out;
}

}  // namespace

const std::vector<RealKind>& real_kinds() {
  static const std::vector<RealKind> all = [] {
    std::vector<RealKind> out;
    for (auto&& part : {noise_kinds(), design_kinds(), wrong_reading_kinds(), disturbance_kinds(),
                        law_kinds(), unlisted_kinds(), mistake_kinds()})
      out.insert(out.end(), part.begin(), part.end());
    return out;
  }();
  return all;
}

const std::vector<RealKind>& site_kinds() {
  static const std::vector<RealKind> all = [] {
    std::vector<RealKind> out;
    for (const double d : {8.0, 15.0, 40.0}) {
      out.push_back(of_site("gradient", {"site.gradient"}, d, [](Random& random) -> Planted {
        return {"site.gradient", "all", direction(random, 5, 1)};
      }));
      out.push_back(of_site("curvature", {"site.curvature"}, d, [](Random& random) -> Planted {
        return {"site.curvature", "all", direction(random, 7, 1)};
      }));
      out.push_back(of_site("dipole", {"site.dipole"}, d, &dipole_at_random));
      out.push_back(of_site("step", {"site.step", "site.gradient-drift"}, d, [](Random& random) -> Planted {
        std::vector<double> numbers = direction(random, 5, 1);
        numbers.push_back(between(random, 400, 1400));
        return {"site.gradient-step", "all", numbers};
      }));
      out.push_back(of_site("transient", {"site.transient", "site.dipole"}, d, [](Random& random) -> Planted {
        const auto moment = vector(random, 60), nearest = vector(random, between(random, 2, 3));
        return {"hidden.passing-iron",
                "all",
                {moment[0], moment[1], moment[2], nearest[0], nearest[1], nearest[2], 0.03,
                 between(random, 400, 1400)}};
      }));
    }
    return out;
  }();
  return all;
}

}  // namespace mgtd::calib::testing
