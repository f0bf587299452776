// SPDX-License-Identifier: Apache-2.0
#include "daemon/serve/control_client.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "tests/support/event_loop.h"

namespace mgtd::daemon::serve {
namespace {

int daemon_end = -1;
volatile std::sig_atomic_t signals = 0;
constexpr std::string_view kAnswer = "{\"id\":1,\"ok\":true,\"result\":7}\n";

/// The third signal brings the answer, so that two come while the client waits for it.
void answer_third(int) {
  signals = signals + 1;
  if (signals == 3) {
    [[maybe_unused]] const ssize_t n = ::write(daemon_end, kAnswer.data(), kAnswer.size());
  }
}

TEST(ControlClient, ASignalDoesNotEndTheWaitForAnAnswer) {
  const testing::ScratchDirectory dir;
  const std::string path = dir / "control.sock";
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  std::copy(path.begin(), path.end(), name.sun_path);
  const int listener = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  ASSERT_EQ(::bind(listener, reinterpret_cast<const sockaddr*>(&name), sizeof name), 0);
  ASSERT_EQ(::listen(listener, 1), 0);
  auto client = ControlClient::connect(path);
  ASSERT_TRUE(client) << client.error().text();
  daemon_end = ::accept(listener, nullptr, nullptr);
  ASSERT_GE(daemon_end, 0);

  struct sigaction before {
  }, on_alarm{};
  on_alarm.sa_handler = answer_third;
  ASSERT_EQ(::sigaction(SIGALRM, &on_alarm, &before), 0);
  const itimerval every_20_ms{{0, 20'000}, {0, 20'000}}, never{};
  ::setitimer(ITIMER_REAL, &every_20_ms, nullptr);
  const auto reply = client->request(ControlCommand::status);
  ::setitimer(ITIMER_REAL, &never, nullptr);
  ::sigaction(SIGALRM, &before, nullptr);
  ::close(daemon_end);
  ::close(listener);
  ASSERT_TRUE(reply) << reply.error().text();
  EXPECT_EQ(*reply, 7);
  EXPECT_GE(signals, 3);
}

}  // namespace
}  // namespace mgtd::daemon::serve
