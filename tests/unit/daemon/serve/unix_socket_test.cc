// SPDX-License-Identifier: Apache-2.0
#include "daemon/serve/unix_socket.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

#include "tests/support/event_loop.h"
#include "tests/support/line_peer.h"

namespace mgtd::daemon::serve {
namespace {

using mgtd::testing::LinePeer;
using mgtd::testing::ScratchDirectory;
using ::testing::HasSubstr;

TEST(UnixSocket, AppearsWithItsPermissionsAndGoesWithItsOwner) {
  const ScratchDirectory scratch;
  const std::string path = scratch / "s.sock";
  {
    const auto socket = UnixSocket::listen(path, 0620);
    ASSERT_TRUE(socket) << socket.error().text();
    struct stat file {};
    ASSERT_EQ(::stat(path.c_str(), &file), 0);
    EXPECT_TRUE(S_ISSOCK(file.st_mode));
    EXPECT_EQ(file.st_mode & 0777U, 0620U);
    EXPECT_TRUE(LinePeer::unix_socket(path).connected());
  }
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(UnixSocket, ReplacesWhatADeadDaemonLeft) {
  const ScratchDirectory scratch;
  const std::string path = scratch / "s.sock";
  {
    auto dead = UnixSocket::listen(path, 0600);
    ASSERT_TRUE(dead);
    std::filesystem::create_hard_link(path, scratch / "kept");
  }
  std::filesystem::rename(scratch / "kept", path);  // as after SIGKILL: the file without its listener
  const auto socket = UnixSocket::listen(path, 0600);
  ASSERT_TRUE(socket) << socket.error().text();
  EXPECT_TRUE(LinePeer::unix_socket(path).connected());
}

TEST(UnixSocket, RespectsALivingDaemon) {
  const ScratchDirectory scratch;
  const std::string path = scratch / "s.sock";
  const auto living = UnixSocket::listen(path, 0600);
  ASSERT_TRUE(living);
  const auto second = UnixSocket::listen(path, 0600);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, ErrorCode::state);
  EXPECT_THAT(second.error().message, HasSubstr("another program is listening at " + path));
  EXPECT_THAT(second.error().remedy, HasSubstr("is mgtd running already"));
  EXPECT_TRUE(LinePeer::unix_socket(path).connected()) << "the first one must be untouched";
}

TEST(UnixSocket, LeavesAFileThatIsNoSocketAlone) {
  const ScratchDirectory scratch;
  const std::string path = scratch / "notes.txt";
  std::ofstream(path) << "precious";
  const auto socket = UnixSocket::listen(path, 0600);
  ASSERT_FALSE(socket);
  EXPECT_THAT(socket.error().message, HasSubstr("is not a socket"));
  std::string kept;
  std::ifstream(path) >> kept;
  EXPECT_EQ(kept, "precious");
}

TEST(UnixSocket, DoesNotRemoveTheSocketOfItsSuccessor) {
  const ScratchDirectory scratch;
  const std::string path = scratch / "s.sock";
  auto first = UnixSocket::listen(path, 0600);
  ASSERT_TRUE(first);
  ::close(first->release());
  const auto successor = UnixSocket::listen(path, 0600);
  ASSERT_TRUE(successor) << successor.error().text();
  first->remove();
  EXPECT_TRUE(LinePeer::unix_socket(path).connected());
}

TEST(UnixSocket, SaysWhyAPathCannotBe) {
  const ScratchDirectory scratch;
  const auto missing = UnixSocket::listen(scratch / "none" + "/s.sock", 0600);
  ASSERT_FALSE(missing);
  EXPECT_THAT(missing.error().remedy, HasSubstr("create its directory"));
  const auto too_long = UnixSocket::listen(scratch / std::string(120, 'x'), 0600);
  ASSERT_FALSE(too_long);
  EXPECT_THAT(too_long.error().message, HasSubstr("1 to 107 are possible"));
  EXPECT_FALSE(UnixSocket::listen("", 0600));
}

TEST(UnixSocket, NobodyThereIsUnreachableWithARemedy) {
  const ScratchDirectory scratch;
  const auto fd = connect_unix(scratch / "s.sock");
  ASSERT_FALSE(fd);
  EXPECT_EQ(fd.error().code, ErrorCode::unreachable);
  EXPECT_THAT(fd.error().remedy, HasSubstr("systemctl status mgtd"));
}

}  // namespace
}  // namespace mgtd::daemon::serve
