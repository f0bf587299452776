// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/input_lines.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <string_view>

#include "daemon/cli/interrupt.h"

namespace mgtd::daemon::cli {
namespace {

/// A pipe in place of the keyboard.
class TypedLines : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(::pipe(ends_.data()), 0); }
  void TearDown() override {
    ::close(ends_[0]);
    end_input();
  }
  void type(std::string_view text) const {
    ASSERT_EQ(::write(ends_[1], text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  void end_input() {
    if (ends_[1] >= 0) ::close(ends_[1]);
    ends_[1] = -1;
  }
  [[nodiscard]] int fd() const { return ends_[0]; }

 private:
  std::array<int, 2> ends_{-1, -1};
};

TEST_F(TypedLines, AreGivenOneByOneAlsoTheLastWithoutAnEnd) {
  type("10 0 0\n\nre");
  InputLines lines(fd());
  EXPECT_EQ(lines.next(), "10 0 0");
  EXPECT_EQ(lines.next(), "");
  type("do");
  end_input();
  EXPECT_EQ(lines.next(), "redo");
  EXPECT_EQ(lines.next(), std::nullopt);
  EXPECT_FALSE(interrupted());
}

// In a process of its own, since a signal stays remembered. A read that misses it waits without end.
TEST_F(TypedLines, ASignalJustBeforeTheWaitEndsIt) {
  EXPECT_EXIT(
      {
        catch_interrupts({SIGUSR1});
        std::raise(SIGUSR1);
        InputLines lines(fd());
        std::_Exit(!lines.next() && interrupted() ? 0 : 1);
      },
      ::testing::ExitedWithCode(0), "");
}

/// Whatever the program waits for after the first, a daemon that hangs for instance.
TEST_F(TypedLines, ASecondCtrlCEndsTheProgram) {
  EXPECT_EXIT(
      {
        catch_interrupts({SIGINT});
        std::raise(SIGINT);
        std::raise(SIGINT);
        std::_Exit(0);
      },
      ::testing::KilledBySignal(SIGINT), "");
}

/// A terminal that is closed sends it twice, and what was begun is to be ended in order.
TEST_F(TypedLines, ATerminalThatClosesDoesNot) {
  EXPECT_EXIT(
      {
        catch_interrupts({SIGHUP});
        std::raise(SIGHUP);
        std::raise(SIGHUP);
        std::_Exit(interrupted() ? 0 : 1);
      },
      ::testing::ExitedWithCode(0), "");
}

TEST_F(TypedLines, ASignalDuringTheWaitEndsIt) {
  EXPECT_EXIT(
      {
        catch_interrupts({SIGALRM});
        ::ualarm(20'000, 0);
        InputLines lines(fd());
        std::_Exit(!lines.next() && interrupted() ? 0 : 1);
      },
      ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace mgtd::daemon::cli
