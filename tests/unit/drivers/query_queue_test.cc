// SPDX-License-Identifier: Apache-2.0
#include "drivers/query_queue.h"

#include <gtest/gtest.h>

namespace mgtd::drivers {
namespace {

enum class Ask { position, error };

/// Questions and their replies are single letters: upper case asks, lower case is the form of the reply.
class QueryQueueTest : public ::testing::Test {
 protected:
  void push(const std::string& letter) {
    queue.push({Ask::position, letter, std::string(1, static_cast<char>(letter[0] + ('a' - 'A')))});
  }
  std::string sent() { return queue.take_send(now); }
  Heard hear(const std::string& form) {
    const Heard heard = queue.hear(form, now);
    if (heard == Heard::answer) {
      believed += queue.current().send;
      queue.answered();
    }
    return heard;
  }
  /// Ticks of 20 ms; what is sent and given up on the way is noted.
  void pass(double seconds) {
    for (const Instant end = now + from_seconds(seconds); now < end;) {
      now += std::chrono::milliseconds(20);
      if (const auto lost = queue.on_tick(now)) given_up += *lost;
      said += sent();
    }
  }
  std::string said_in(double seconds) {
    said.clear();
    pass(seconds);
    return said;
  }
  QueryQueue<Ask> queue{{{"X", "x"}, {"Y", "y"}, {"Z", "z"}}};
  Instant now{};
  std::string given_up, said, believed;
};

TEST_F(QueryQueueTest, OneQuestionAtATime) {
  push("A");
  push("B");
  EXPECT_EQ(sent(), "A");
  EXPECT_EQ(sent(), "");
  EXPECT_EQ(hear("a"), Heard::answer);
  EXPECT_EQ(sent(), "B");
  EXPECT_EQ(hear("b"), Heard::answer);
  EXPECT_TRUE(queue.idle());
}

TEST_F(QueryQueueTest, AnAnswerThatTakesTwoSecondsIsAnAnswer) {
  push("A");
  EXPECT_EQ(sent(), "A");
  EXPECT_EQ(said_in(2.1), "");
  EXPECT_EQ(hear("a"), Heard::answer);
}

TEST_F(QueryQueueTest, AQuestionWithoutAnAnswerIsAskedAgainWhenTheLineIsProved) {
  push("A");
  EXPECT_EQ(sent(), "A");
  EXPECT_EQ(said_in(2.6), "X");
  EXPECT_EQ(hear("a"), Heard::passed_over) << "late";
  EXPECT_EQ(hear("x"), Heard::passed_over);
  EXPECT_EQ(said_in(0.2), "A");
  EXPECT_EQ(hear("a"), Heard::answer);
  EXPECT_EQ(believed, "A");
}

TEST_F(QueryQueueTest, ALateAnswerIsNotTakenForThatOfTheNextQuestion) {
  push("A");
  EXPECT_EQ(sent(), "A");
  queue.interrupt("!", now);
  push("A");
  EXPECT_EQ(sent(), "!");
  EXPECT_EQ(said_in(1), "") << "the first A is owed";
  EXPECT_EQ(hear("a"), Heard::passed_over);
  EXPECT_EQ(said_in(0.2), "X");
  EXPECT_EQ(hear("x"), Heard::passed_over);
  EXPECT_EQ(said_in(0.2), "A");
  EXPECT_EQ(hear("a"), Heard::answer);
  EXPECT_TRUE(queue.idle());
}

TEST_F(QueryQueueTest, AnAnswerLaterThanAllPatienceIsPassedOverToo) {
  push("A");
  EXPECT_EQ(sent(), "A");
  queue.interrupt("!", now);
  push("A");
  EXPECT_EQ(said_in(2.6), "!X");
  EXPECT_EQ(hear("a"), Heard::passed_over);
  EXPECT_EQ(said_in(0.2), "") << "the proof is not there yet";
  EXPECT_EQ(hear("x"), Heard::passed_over);
  EXPECT_EQ(said_in(0.2), "A");
}

TEST_F(QueryQueueTest, AProofThatIsOwedIsNoProof) {
  push("X");
  EXPECT_EQ(sent(), "X");
  queue.interrupt("!", now);
  push("A");
  EXPECT_EQ(said_in(2.6), "!Y") << "x may come from before";
  EXPECT_EQ(hear("x"), Heard::passed_over);
  EXPECT_EQ(said_in(0.2), "");
  EXPECT_EQ(hear("y"), Heard::passed_over);
  EXPECT_EQ(said_in(0.2), "A");
}

TEST_F(QueryQueueTest, WhenAllProofsAreOwedItTakesTwo) {
  queue.open("!", now);
  push("A");
  EXPECT_EQ(said_in(0.4), "!X") << "owed last";
  EXPECT_EQ(hear("x"), Heard::passed_over) << "perhaps that of an earlier program";
  EXPECT_EQ(sent(), "Y");
  EXPECT_EQ(said_in(0.2), "");
  EXPECT_EQ(hear("x"), Heard::passed_over) << "so it was";
  EXPECT_EQ(hear("y"), Heard::passed_over);
  EXPECT_EQ(said_in(0.2), "A");
}

TEST_F(QueryQueueTest, AStrangeLineUpsetsALineInStep) {
  push("A");
  EXPECT_EQ(sent(), "A");
  EXPECT_EQ(hear("?"), Heard::strange);
  EXPECT_EQ(hear("a"), Heard::passed_over);
  EXPECT_EQ(said_in(0.2), "X");
  EXPECT_EQ(hear("x"), Heard::passed_over);
  EXPECT_EQ(hear("a"), Heard::strange) << "something follows the proof: it was none";
  EXPECT_EQ(said_in(0.2), "X");
  EXPECT_EQ(hear("x"), Heard::passed_over);
  EXPECT_EQ(said_in(0.2), "A");
  EXPECT_EQ(hear("a"), Heard::answer);
}

TEST_F(QueryQueueTest, GivesUpAfterThreeRepliesThatDidNotCome) {
  push("A");
  EXPECT_EQ(said_in(7), "AXY");
  EXPECT_EQ(given_up, "");
  pass(1);
  EXPECT_EQ(given_up, "Y");
}

TEST_F(QueryQueueTest, GivesUpAQuestionThatOnlyProofsAnswer) {
  push("A");
  for (int i = 0; i < 400 && given_up.empty(); ++i) {
    if (!said_in(0.1).ends_with("X")) continue;
    EXPECT_EQ(hear("x"), Heard::passed_over);
  }
  EXPECT_EQ(given_up, "A");
}

TEST_F(QueryQueueTest, GivesUpALineThatTalksByItself) {
  push("A");
  for (int i = 0; i < 100 && given_up.empty(); ++i) {
    pass(1);
    EXPECT_NE(hear("?"), Heard::answer);
  }
  EXPECT_FALSE(given_up.empty());
  EXPECT_EQ(believed, "");
}

/// Whatever is lost or late: an answer that is believed is the one of the question under way.
TEST_F(QueryQueueTest, NoLateAnswerIsEverBelieved) {
  std::uint64_t state = 1;
  const auto chance = [&] {
    return static_cast<double>((state = state * 6364136223846793005U + 1) >> 40U) / (1U << 24U);
  };
  struct Reply {
    Instant at;
    std::string form;
    std::string to;
    int nth;
  };
  std::deque<Reply> line;
  int asked = 0, answers = 0;
  push("A");
  for (int tick = 0; tick < 100'000; ++tick) {
    now += std::chrono::milliseconds(20);
    if (queue.on_tick(now) || chance() < 0.001) {
      queue.clear();
      queue.interrupt("", now);
    }
    if (queue.idle()) push(chance() < 0.5 ? "A" : chance() < 0.5 ? "X" : "B");
    for (const char c : sent()) {
      ++asked;
      if (chance() < 0.02) continue;  // lost
      const double late_s = chance() < 0.3 ? 5 * chance() : 0;
      const Instant at = now + from_seconds(late_s);
      line.push_back({line.empty() ? at : std::max(at, line.back().at),
                      std::string(1, static_cast<char>(c + 32)), std::string(1, c), asked});
    }
    while (!line.empty() && line.front().at <= now) {
      const Reply reply = line.front();
      line.pop_front();
      if (hear(reply.form) != Heard::answer) continue;
      ++answers;
      ASSERT_EQ(reply.nth, asked) << "the answer of an earlier question, at tick " << tick;
    }
  }
  EXPECT_GT(answers, 300);
}

}  // namespace
}  // namespace mgtd::drivers
