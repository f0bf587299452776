// SPDX-License-Identifier: Apache-2.0
#include "drivers/query_queue.h"

#include <gtest/gtest.h>

namespace mgtd::drivers {
namespace {

enum class Ask { position, error };

class QueryQueueTest : public ::testing::Test {
 protected:
  void push(const std::string& text, bool answered = true) {
    queue.push({Ask::position, text, 0, "", answered});
  }
  std::string sent() { return queue.take_send(now); }
  /// Ticks of 20 ms; what was given up on the way is noted.
  void pass(double seconds) {
    for (const Instant end = now + from_seconds(seconds); now < end;) {
      now += std::chrono::milliseconds(20);
      if (const auto lost = queue.on_tick(now)) given_up += lost->send;
    }
  }
  QueryQueue<Ask> queue;
  Instant now{};
  std::string given_up;
};

TEST_F(QueryQueueTest, OneQuestionAtATime) {
  push("a");
  push("b");
  EXPECT_EQ(sent(), "a");
  EXPECT_EQ(sent(), "");
  ASSERT_NE(queue.expecting(), nullptr);
  queue.answered(now);
  EXPECT_EQ(sent(), "b");
  queue.answered(now);
  EXPECT_TRUE(queue.idle());
}

TEST_F(QueryQueueTest, MessagesWithoutAReplyAreFollowedAtOnce) {
  push("set", false);
  push("err?");
  EXPECT_EQ(sent(), "seterr?");
}

TEST_F(QueryQueueTest, AsksAgainAfterAQuietLineAndGivesUpAfterThree) {
  push("a");
  EXPECT_EQ(sent(), "a");
  pass(2.1);
  EXPECT_EQ(queue.expecting(), nullptr) << "a late answer would not be taken";
  queue.disturbed(now);  // and here it comes: the quiet starts anew
  pass(0.2);
  EXPECT_EQ(sent(), "");
  pass(0.2);
  EXPECT_EQ(sent(), "a");
  pass(2.5);
  EXPECT_EQ(sent(), "a");
  pass(2.5);
  EXPECT_EQ(sent(), "");
  EXPECT_EQ(given_up, "a");
}

TEST_F(QueryQueueTest, ARepeatedQuestionLetsItsLateAnswerPass) {
  push("a");
  push("b");
  EXPECT_EQ(sent(), "a");
  pass(2.5);
  EXPECT_EQ(sent(), "a");
  queue.answered(now);  // by the first or the second asking: nobody can tell
  EXPECT_EQ(sent(), "") << "b waits";
  EXPECT_EQ(queue.expecting(), nullptr);
  pass(0.4);
  EXPECT_EQ(sent(), "b");
}

TEST_F(QueryQueueTest, AnInterruptionGoesFirstAndForgetsTheRest) {
  push("a");
  push("b");
  EXPECT_EQ(sent(), "a");
  queue.interrupt("!", now);
  push("c");
  EXPECT_EQ(sent(), "!");
  EXPECT_EQ(queue.expecting(), nullptr);
  pass(0.4);
  EXPECT_EQ(sent(), "c");
}

}  // namespace
}  // namespace mgtd::drivers
