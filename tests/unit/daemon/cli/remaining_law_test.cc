// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/remaining_law.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "calib/effects/library/library.h"

namespace mgtd::daemon::cli {
namespace {

using calib::criticism::search::Finding;
using calib::discovery::RemainingLaw;
using ::testing::HasSubstr;

std::vector<calib::effects::EffectPtr> model(const char* spec) {
  return {calib::effects::library::make_effect(spec, 4).value()};
}

std::optional<RemainingLaw> law(const std::vector<calib::effects::EffectPtr>& beside,
                                const std::vector<std::string>& instead_of) {
  return RemainingLaw{
      .found = calib::discovery::DiscoveryReport{}, .model = beside, .instead_of = instead_of};
}

TEST(RemainingLaw, SaysWhatItStandsInsteadOfAndBeside) {
  const auto text = [](const auto& of) { return law_text(of, {}, "run.csv"); };
  EXPECT_THAT(text(law({}, {})), HasSubstr("A formula for what remains (mgt"));
  EXPECT_THAT(text(law(model("axis.cubic@s1.x"), {})),
              HasSubstr("A formula for what remains beside axis.cubic@s1.x (mgt"));
  EXPECT_THAT(text(law({}, {"axis.quadratic@s2.z"})),
              HasSubstr("A formula for everything, instead of axis.quadratic@s2.z (mgt"));
  EXPECT_THAT(
      text(law(model("axis.cubic@s1.x"), {"axis.quadratic@s2.z"})),
      HasSubstr("A formula for everything beside axis.cubic@s1.x, instead of axis.quadratic@s2.z (mgt"));
  EXPECT_EQ(law_json(law({}, {"axis.quadratic@s2.z"}), {}, "run.csv")["instead_of"],
            nlohmann::json::array({"axis.quadratic@s2.z"}));
}

TEST(RemainingLaw, IsNotLookedForWhereNothingRemains) {
  for (const Finding done : {Finding::pass, Finding::explained, Finding::ambiguous, Finding::bad_data}) {
    const auto none = law_of_the_rest({}, {}, {}, done);
    EXPECT_FALSE(none);
    EXPECT_EQ(law_text(none, {}, "run.csv"), "");
    EXPECT_TRUE(law_json(none, {}, "run.csv").is_null());
  }
}

TEST(RemainingLaw, ASearchThatIsRefusedSaysWhy) {
  const auto refused = law_of_the_rest({}, {}, {}, Finding::unknown);
  ASSERT_TRUE(refused);
  ASSERT_FALSE(refused->found);
  EXPECT_THAT(law_text(refused, {}, "run.csv"), HasSubstr("No formula was looked for: "));
  EXPECT_EQ(law_json(refused, {}, "run.csv")["refused"], refused->found.error().message);
}

}  // namespace
}  // namespace mgtd::daemon::cli
