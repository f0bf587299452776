// SPDX-License-Identifier: Apache-2.0
#include "calib/report/figures/escaped.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <string>

namespace mgtd::calib::report::figures {
namespace {

TEST(Escaped, NamesOfColumnsCannotBecomeMarkup) {
  EXPECT_EQ(escaped("a<b>&\"c\""), "a&lt;b&gt;&amp;&quot;c&quot;");
  EXPECT_EQ(escaped("' onload='x"), "&#39; onload=&#39;x");
  EXPECT_EQ(escaped("nT/°C · s3"), "nT/°C · s3");
}

TEST(Escaped, WhatXmlCannotHoldIsReplaced) {
  const std::string replaced = "\xef\xbf\xbd";
  EXPECT_EQ(escaped(std::string("a\0b", 3)), "a" + replaced + "b");
  EXPECT_EQ(escaped("\x1b[31m"), replaced + "[31m");
  EXPECT_EQ(escaped("\xc0\xbc"), replaced + replaced);                 // "<" in two bytes
  EXPECT_EQ(escaped("\xed\xa0\x80"), replaced + replaced + replaced);  // half of a surrogate pair
  EXPECT_EQ(escaped("caf\xc3"), "caf" + replaced);                     // cut off
}

RC_GTEST_PROP(Escaped, LeavesNothingThatOpensOrCloses, ()) {
  const auto bytes = *rc::gen::container<std::string>(rc::gen::arbitrary<char>());
  const std::string out = escaped(bytes);
  RC_ASSERT(out.find_first_of("<>\"'") == std::string::npos);
  for (std::size_t i = 0; i < out.size();) {
    const std::size_t length = utf8_length(std::string_view(out).substr(i));
    RC_ASSERT(length > 0U);
    i += length;
  }
  for (std::size_t at = out.find('&'); at != std::string::npos; at = out.find('&', at + 1))
    RC_ASSERT(out.find(';', at) != std::string::npos);
}

}  // namespace
}  // namespace mgtd::calib::report::figures
