// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/library.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "calib/effects/site_gradient.h"

namespace mgtd::calib {
namespace {

struct Entry {
  std::string_view name;
  EffectPtr (*make)();
};

template <class E>
EffectPtr make() {
  return std::make_shared<const E>();
}

constexpr std::array kLibrary{Entry{"site.gradient", &make<SiteGradient>}};

}  // namespace

std::vector<std::string_view> effect_names() {
  std::vector<std::string_view> names;
  for (const Entry& entry : kLibrary) names.push_back(entry.name);
  return names;
}

Result<EffectPtr> make_effect(std::string_view name) {
  const auto* found =
      std::find_if(kLibrary.begin(), kLibrary.end(), [&](const Entry& e) { return e.name == name; });
  if (found != kLibrary.end()) return found->make();
  return fail(ErrorCode::usage, fmt::format("no effect is called '{}'", name),
              fmt::format("known effects: {}", fmt::join(effect_names(), ", ")));
}

}  // namespace mgtd::calib
