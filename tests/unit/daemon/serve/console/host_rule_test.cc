// SPDX-License-Identifier: Apache-2.0
#include "daemon/serve/console/host_rule.h"

#include <gmock/gmock.h>

#include <rapidcheck.h>

#include <string>

#include "daemon/serve/console/console_token.h"

namespace mgtd::daemon::serve::console {
namespace {

using ::testing::HasSubstr;

HostRule rule() { return HostRule(7451, {"Rig7.local", "10.0.0.5"}); }

TEST(HostRule, OwnNamesAreAnswered) {
  for (const char* host : {"127.0.0.1:7451", "localhost:7451", "LOCALHOST:7451", "[::1]:7451",
                           "rig7.local:7451", "10.0.0.5:7451"})
    EXPECT_TRUE(rule().admit({.host = host})) << host;
  EXPECT_TRUE(rule().admit({.host = "rig7.local:7451",
                            .origin = "http://rig7.local:7451",
                            .fetch_site = "same-origin",
                            .websocket = true}));
  EXPECT_TRUE(rule().admit({.host = "localhost:7451", .fetch_site = "none"})) << "typed by a person";
}

TEST(HostRule, WhatAnotherPageAsksIsRefusedWithTheHeaderThatSaysSo) {
  struct Case {
    RequestHead head;
    const char* says;
  };
  const Case cases[] = {
      {{.host = ""}, "Host"},
      {{.host = "127.0.0.1"}, "Host"},  // another port
      {{.host = "127.0.0.1:80"}, "Host"},
      {{.host = "evil.org:7451"}, "Host"},  // after DNS rebinding
      {{.host = "127.0.0.1.evil.org:7451"}, "Host"},
      {{.host = "localhost:7451@evil.org"}, "Host"},
      {{.host = "localhost:7451", .origin = "http://evil.org"}, "Origin"},
      {{.host = "localhost:7451", .origin = "null"}, "Origin"},
      {{.host = "localhost:7451", .origin = "http://localhost"}, "Origin"},
      {{.host = "localhost:7451", .origin = "https://localhost:7451"}, "Origin"},
      {{.host = "localhost:7451", .origin = "http://localhost:7451.evil.org"}, "Origin"},
      {{.host = "evil.org:7451", .origin = "http://evil.org:7451"}, "Host"},  // equal to each other
      {{.host = "localhost:7451", .fetch_site = "cross-site"}, "Sec-Fetch-Site"},
      {{.host = "localhost:7451", .fetch_site = "same-site"}, "Sec-Fetch-Site"},
      {{.host = "localhost:7451", .websocket = true}, "WebSocket"},
  };
  for (const Case& c : cases) {
    const auto refused = rule().admit(c.head);
    ASSERT_FALSE(refused) << c.head.host;
    EXPECT_THAT(refused.error().message, HasSubstr(c.says)) << c.head.host;
    EXPECT_FALSE(refused.error().remedy.empty());
  }
}

TEST(HostRule, NoOtherHostIsEverAnswered) {
  rc::check("a host that is not in the list is refused", [](const std::string& host) {
    const HostRule own = rule();
    const bool listed = host == "127.0.0.1:7451" || host == "localhost:7451";
    RC_ASSERT(own.admit({.host = host}).has_value() == listed);
  });
}

TEST(ConsoleToken, IsLongRandomAndComparedWhole) {
  const ConsoleToken token = ConsoleToken::random();
  EXPECT_EQ(token.text().size(), 32U);
  EXPECT_NE(token.text(), ConsoleToken::random().text());
  EXPECT_TRUE(token.is(token.text()));
  EXPECT_FALSE(token.is(""));
  EXPECT_FALSE(token.is(token.text().substr(1)));
  EXPECT_FALSE(token.is(token.text() + "0"));
  std::string other = token.text();
  other.back() = other.back() == '0' ? '1' : '0';
  EXPECT_FALSE(token.is(other));
}

}  // namespace
}  // namespace mgtd::daemon::serve::console
