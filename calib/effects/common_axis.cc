// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/common_axis.h"

#include "calib/effects/effect_spec.h"

namespace mgtd::calib::effects {

namespace {

/// Both have a place given, and not the same one.
bool at_places_of_their_own(const EffectSpec& a, const EffectSpec& b) {
  bool differ = false;
  for (const char* coordinate : {"x", "y", "z"}) {
    const std::string *const of_a = a.find(coordinate), *const of_b = b.find(coordinate);
    if (of_a == nullptr || of_b == nullptr) return false;
    differ = differ || *of_a != *of_b;
  }
  return differ;
}

}  // namespace

bool share_an_axis(const Where& a, const Where& b) {
  for (int s = 0; s < kMostSensors; ++s) {
    for (int x = 0; x < 3; ++x)
      if (a.covers(s, x) && b.covers(s, x)) return true;
  }
  return false;
}

bool same_law_on_a_common_axis(const Effect& a, const Effect& b) {
  if (a.name() != b.name()) return false;
  const auto spec_a = EffectSpec::parse(a.spec()), spec_b = EffectSpec::parse(b.spec());
  if (!spec_a || !spec_b) return true;
  if (at_places_of_their_own(*spec_a, *spec_b)) return false;
  if (!spec_a->where || !spec_b->where) return true;
  return share_an_axis(*spec_a->where, *spec_b->where);
}

}  // namespace mgtd::calib::effects
