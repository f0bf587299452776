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
     {}},
    {"creep", "creep,tau=2..120,expr=exp(-since_stop_s/tau)", "h2", {}, -12.5}};

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

TEST(Definitions, ANameBecomesTheWholeFormula) {
  EXPECT_EQ(whole_spec("lamp", kTwo), kTwo[0].spec);
  EXPECT_EQ(whole_spec("lamp@s3.z", kTwo), "lamp@s3.z,level=platform,unit=nT/A,expr=min(lamp_A,2)");
  EXPECT_EQ(whole_spec("creep,tau=30", kTwo), "creep,tau=30,expr=exp(-since_stop_s/tau)");
  EXPECT_EQ(whole_spec("site.gradient", kTwo), "site.gradient");
  EXPECT_EQ(whole_spec(kTwo[1].spec, kTwo), kTwo[1].spec);
}

}  // namespace
}  // namespace mgtd::daemon::store
