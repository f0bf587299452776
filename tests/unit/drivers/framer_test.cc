// SPDX-License-Identifier: Apache-2.0
#include "drivers/framer.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <string>
#include <vector>

namespace mgtd::drivers {
namespace {

std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

struct Taken {
  std::vector<std::string> frames;
  LinkHealth health;
  int damaged{0};
  bool balanced{true};
};

/// Feeds `text` in pieces that end at the given places; the books must balance after every piece.
Taken run(Ending ending, std::string_view text, std::vector<std::size_t> cuts = {},
          std::size_t longest = 64) {
  Framer framer(ending, longest);
  Taken taken;
  cuts.push_back(text.size());
  std::size_t from = 0;
  for (const std::size_t to : cuts) {
    framer.feed(bytes_of(text.substr(from, to - from)), taken.health, [&](const Frame& frame) {
      if (frame.damage) {
        ++taken.damaged;
        return FrameResult::accepted();  // not asked
      }
      taken.frames.emplace_back(frame.text);
      if (frame.text.starts_with('?')) return FrameResult::rejected(Reject::number);
      if (frame.text.empty()) return FrameResult::resync();
      return FrameResult::accepted();
    });
    taken.balanced = taken.balanced && taken.health.balanced();
    from = to;
  }
  EXPECT_TRUE(taken.balanced);
  return taken;
}

TEST(Framer, CutsAtCarriageReturns) {
  const Taken taken = run(Ending::cr, "*abc\r!01\r\n?x\rrest");
  EXPECT_EQ(taken.frames, (std::vector<std::string>{"*abc", "!01", "?x"}));
  EXPECT_EQ(taken.health.frames, 2U);
  EXPECT_EQ(taken.health.bytes_in_frames, 9U);
  EXPECT_EQ(taken.health.bytes_rejected, 4U);  // the LF in front belongs to the line it precedes
  EXPECT_EQ(taken.health.bytes_pending, 4U);
  EXPECT_EQ(taken.health.rejected[static_cast<std::size_t>(Reject::number)], 1U);
}

TEST(Framer, CutsAtLineFeedsAndDropsTheCarriageReturn) {
  EXPECT_EQ(run(Ending::lf, "115014.0  48484.12 99\r\nx\n").frames,
            (std::vector<std::string>{"115014.0  48484.12 99", "x"}));
}

TEST(Framer, KeepsAReplyOfSeveralLinesTogether) {
  EXPECT_EQ(run(Ending::gcs, "1=1.0 \n2=2.0 \n3=3.0\n0\n").frames,
            (std::vector<std::string>{"1=1.0 \n2=2.0 \n3=3.0", "0"}));
}

TEST(Framer, TakesAStatusByteAsAFrame) {
  EXPECT_EQ(run(Ending::gcs, "\xB1\n1=1\n").frames, (std::vector<std::string>{"\xB1", "", "1=1"}));
  EXPECT_EQ(run(Ending::gcs, "\xB1").frames.size(), 1U);  // with or without a line feed
}

TEST(Framer, RefusesWhatIsTooLongAndFindsTheNextLine) {
  const Taken taken = run(Ending::cr, std::string(200, 'x') + "\rok\r");
  EXPECT_EQ(taken.frames, std::vector<std::string>{"ok"});
  EXPECT_EQ(taken.health.rejected[static_cast<std::size_t>(Reject::length)], 1U);
  EXPECT_EQ(taken.damaged, 1);
  EXPECT_EQ(taken.health.bytes_rejected, 64U);
  EXPECT_EQ(taken.health.bytes_resync, 137U);
}

TEST(Framer, RefusesBytesNoLineContains) {
  const Taken taken = run(Ending::cr, "a\x01z\rok\r");
  EXPECT_EQ(taken.frames, std::vector<std::string>{"ok"});
  EXPECT_EQ(taken.damaged, 1);
  EXPECT_EQ(taken.health.rejected[static_cast<std::size_t>(Reject::framing)], 1U);
}

TEST(Framer, GivesUpAnUnfinishedFrame) {
  Framer framer(Ending::cr, 64);
  LinkHealth health;
  std::vector<std::string> frames;
  const auto take = [&](const Frame& frame) {
    frames.emplace_back(frame.text);
    return FrameResult::accepted();
  };
  framer.feed(bytes_of("half a li"), health, take);
  framer.drop(health);
  EXPECT_TRUE(health.balanced());
  EXPECT_EQ(health.bytes_resync, 9U);
  framer.feed(bytes_of("whole\r"), health, take);
  EXPECT_EQ(frames, std::vector<std::string>{"whole"});
}

TEST(Framer, SaysHowManyBytesCameBehind) {
  Framer framer(Ending::cr, 64);
  LinkHealth health;
  std::vector<std::size_t> behind;
  framer.feed(bytes_of("ab\rcd\re"), health, [&](const Frame& frame) {
    behind.push_back(frame.bytes_after);
    return FrameResult::accepted();
  });
  EXPECT_EQ(behind, (std::vector<std::size_t>{4, 1}));
}

/// Garbage with a good share of endings, spaces, status bytes and printable text.
rc::Gen<std::string> garbage() {
  static constexpr std::string_view kLikely = "\r\n \n*!01=ABCDEF?\xB1\x07";
  const auto likely = rc::gen::elementOf(std::string(kLikely));
  return rc::gen::container<std::string>(
      rc::gen::weightedOneOf<char>({{4, likely}, {1, rc::gen::arbitrary<char>()}}));
}

TEST(Framer, AnySplitGivesTheSameFramesAndBooks) {
  const bool holds = rc::check("split anywhere, same frames, books in balance", [] {
    const std::string text = *rc::gen::scale(4.0, garbage());
    auto cuts =
        *rc::gen::container<std::vector<std::size_t>>(rc::gen::inRange<std::size_t>(0, text.size() + 1));
    std::sort(cuts.begin(), cuts.end());
    const Ending ending = *rc::gen::element(Ending::cr, Ending::lf, Ending::gcs);
    const Taken whole = run(ending, text, {}, 32);
    const Taken split = run(ending, text, cuts, 32);
    RC_ASSERT(whole.frames == split.frames);
    RC_ASSERT(whole.damaged == split.damaged);
    RC_ASSERT(whole.health.rejected == split.health.rejected);
    RC_ASSERT(whole.health.bytes_in_frames == split.health.bytes_in_frames);
    RC_ASSERT(whole.health.bytes_resync == split.health.bytes_resync);
    RC_ASSERT(whole.health.bytes_pending == split.health.bytes_pending);
    RC_ASSERT(split.balanced);
  });
  EXPECT_TRUE(holds);
}

}  // namespace
}  // namespace mgtd::drivers
