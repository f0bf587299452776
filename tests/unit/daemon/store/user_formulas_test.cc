// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/user_formulas.h"

#include <gtest/gtest.h>

namespace mgtd::daemon::store {
namespace {

const std::vector<Definition> kTwo{
    {"lamp",
     "lamp@each-sensor,level=platform,unit=nT/A,expr=min(lamp_A,2)",
     "h1",
     {{"s1.x", 1.5, 0.1, "nT/A"}},
     {},
     {}},
    {"creep", "creep,tau=2..120,expr=exp(-since_stop_s/tau)", "h2", {}, -12.5, {}}};

TEST(Definitions, ReadBackAsTheyWereWritten) {
  const auto read = definitions_from_text(to_text(kTwo));
  ASSERT_TRUE(read) << read.error().text();
  ASSERT_EQ(read->size(), 2U);
  EXPECT_EQ((*read)[0].spec, kTwo[0].spec);
  EXPECT_EQ((*read)[0].found_on, "h1");
  EXPECT_EQ((*read)[0].found[0].value, 1.5);
  EXPECT_TRUE((*read)[0].exploratory());
  EXPECT_EQ((*read)[1].confirmed_log10_p, -12.5);
  EXPECT_FALSE(definitions_from_text("[{\"name\":\"x\"}]"));
  EXPECT_FALSE(definitions_from_text("not json"));
}

TEST(Definitions, KeepHowTheyWereDiscovered) {
  std::vector<Definition> one{kTwo.front()};
  one.front().discovered = Discovered{.word = "LAW-SET",
                                      .P = 0.82,
                                      .others = {{"z^6", "s3.z", 0.15, "law1@s3.z,expr=(u/50000)^6"}},
                                      .more = 2,
                                      .data_hash = "h1"};
  const auto read = definitions_from_text(to_text(one));
  ASSERT_TRUE(read) << read.error().text();
  ASSERT_TRUE(read->front().discovered);
  EXPECT_EQ(read->front().discovered->text(),
            "found by mgt discover (LAW-SET, P 0.82); could also be z^6 at s3.z (0.15), 2 more");
  EXPECT_EQ(to_text(*read), to_text(one));
  EXPECT_FALSE(definitions_from_text(to_text(kTwo))->front().discovered);
}

/// Files of version 0.1.0 have no key "discovered".
TEST(Definitions, OfAnEarlierVersionAreRead) {
  const auto read = definitions_from_text(
      R"([{"name": "lamp", "spec": "lamp,expr=lamp_A", "found_on": "h", "found": [], "confirmed_log10_p": null}])");
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_FALSE(read->front().discovered);
  EXPECT_FALSE(definitions_from_text(
      R"([{"name": "lamp", "spec": "lamp,expr=lamp_A", "found_on": "h", "found": [], "confirmed_log10_p": null, "discovered": {"word": 3}}])"));
}

TEST(Definitions, ANameBecomesTheWholeFormula) {
  EXPECT_EQ(whole_spec("lamp", kTwo), kTwo[0].spec);
  EXPECT_EQ(whole_spec("lamp@s3.z", kTwo), "lamp@s3.z,level=platform,unit=nT/A,expr=min(lamp_A,2)");
  EXPECT_EQ(whole_spec("creep,tau=30", kTwo), "creep,tau=30,expr=exp(-since_stop_s/tau)");
  EXPECT_EQ(whole_spec("site.gradient", kTwo), "site.gradient");
  EXPECT_EQ(whole_spec(kTwo[1].spec, kTwo), kTwo[1].spec);
}

}  // namespace
}  // namespace mgtd::daemon::store
