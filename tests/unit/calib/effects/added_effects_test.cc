// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/added_effects.h"

#include <gmock/gmock.h>

#include "calib/effects/library/library.h"

namespace mgtd::calib::effects {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

EffectPtr effect(const std::string& spec) { return library::make_effect(spec, 4).value(); }

TEST(AddedEffects, AreThoseThatWereNotGiven) {
  const std::vector<EffectPtr> given{effect("axis.cubic@s1.x")},
      model{effect("axis.cubic@s1.x"), effect("site.gradient")};
  EXPECT_THAT(specs_of(added_effects(model, given)), ElementsAre("site.gradient"));
  EXPECT_THAT(added_effects(given, given), IsEmpty());
}

/// A law that is found on all axes takes the place of that on one, behind the dipole that was found before.
TEST(AddedEffects, ADipoleIsOneOfThemWhereAnEffectThatWasGivenIsReplaced) {
  const std::vector<EffectPtr> given{effect("axis.quadratic@s3.z")},
      model{effect("site.dipole,x=1,y=0,z=0"), effect("axis.quadratic")};
  EXPECT_THAT(specs_of(added_effects(model, given)), ElementsAre(model[0]->spec(), model[1]->spec()));
}

TEST(AddedEffects, ADipoleOfAnotherPlaceIsNotTheOneThatWasGiven) {
  const std::vector<EffectPtr> given{effect("site.dipole,x=1,y=0,z=0")},
      model{effect("site.dipole,x=1,y=0,z=0"), effect("site.dipole,x=-1,y=0,z=0")};
  EXPECT_THAT(added_effects(model, given), ElementsAre(model[1]));
}

}  // namespace
}  // namespace mgtd::calib::effects
