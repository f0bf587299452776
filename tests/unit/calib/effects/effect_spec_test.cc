// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/effect_spec.h"

#include <gmock/gmock.h>

#include "calib/effects/library/effect_family.h"
#include "calib/effects/library/library.h"

namespace mgtd::calib::effects {
namespace {

using ::testing::HasSubstr;

TEST(EffectSpec, TextReadsBackToItself) {
  for (const char* text : {"site.gradient", "axis.offset.temperature@s3.z", "axis.gain.step@all,c=12500",
                           "axis.offset.step@s2,ts=0.75", "axis.gain.drift@each-sensor"}) {
    const auto spec = EffectSpec::parse(text);
    ASSERT_TRUE(spec) << text;
    EXPECT_EQ(spec->text(), text);
    const auto effect = library::make_effect(text);
    ASSERT_TRUE(effect) << effect.error().text();
    EXPECT_EQ((*effect)->spec(), text);
    EXPECT_EQ((*effect)->name(), family_name(text));
  }
}

TEST(EffectSpec, DefaultsAreSpelledOut) {
  EXPECT_EQ((*library::make_effect("axis.offset.temperature"))->spec(), "axis.offset.temperature@each-axis");
  EXPECT_EQ((*library::make_effect("site.gradient@site"))->spec(), "site.gradient");
}

TEST(EffectSpec, NonsenseIsRefusedWithWhatIsKnown) {
  const auto message = [](const char* text) {
    const auto effect = library::make_effect(text);
    return effect ? std::string("accepted") : effect.error().text();
  };
  EXPECT_THAT(message("axis.cubik"), HasSubstr("no effect is called 'axis.cubik'"));
  EXPECT_THAT(message("axis.gain.drift@s5"), HasSubstr("the array has 4 sensors"));
  EXPECT_THAT(message("axis.gain.drift@s17"), HasSubstr("'s17' is no place"));
  EXPECT_THAT(message("axis.gain.drift@site"), HasSubstr("cannot be laid over"));
  EXPECT_THAT(message("site.gradient@s2"), HasSubstr("leave the part after '@' out"));
  EXPECT_THAT(message("axis.gain.drift,w=1"), HasSubstr("no parameter 'w'"));
  EXPECT_THAT(message("axis.gain.step,c=x"), HasSubstr("c=x is no number"));
  EXPECT_THAT(message("axis.gain.step,c"), HasSubstr("not PARAM=VALUE"));
}

TEST(AxisScale, CoarserScalesAreSumsOfTheFinest) {
  const auto count = [](const char* text) { return (*library::make_effect(text))->coefficients().size(); };
  EXPECT_EQ(count("axis.offset.drift"), 12U);
  EXPECT_EQ(count("axis.offset.drift@each-sensor"), 4U);
  EXPECT_EQ(count("axis.offset.drift@all"), 1U);
  EXPECT_EQ(count("axis.offset.drift@s3"), 1U);
  EXPECT_EQ(count("axis.offset.drift@s3.z"), 1U);
  const auto finest = *library::make_effect("axis.offset.drift");
  EXPECT_EQ(finest->coefficients().front().name, "s1.x");
  EXPECT_EQ(finest->coefficients().back().name, "s4.z");
}

}  // namespace
}  // namespace mgtd::calib::effects
