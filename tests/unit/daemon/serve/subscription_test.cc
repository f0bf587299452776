// SPDX-License-Identifier: Apache-2.0
#include "daemon/serve/subscription.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

namespace mgtd::daemon::serve {
namespace {

using Json = nlohmann::json;
constexpr std::size_t kNoLimit = std::size_t{1} << 30U;

void push_sample(SampleRing& ring, std::uint64_t seq, double t_s) {
  ring.push_sample(seq, Instant{from_seconds(t_s)}, Json{{"class", "TENSOR"}, {"seq", seq}}.dump());
}

/// Samples first .. last at 50 Hz.
void push_samples(SampleRing& ring, std::uint64_t first, std::uint64_t last) {
  for (std::uint64_t seq = first; seq <= last; ++seq) push_sample(ring, seq, static_cast<double>(seq) / 50);
}

WatchRequest samples_from(std::optional<std::uint64_t> from_seq) {
  WatchRequest request{StreamClasses{}, std::nullopt, from_seq};
  request.classes.add(StreamClass::tensor);
  return request;
}

std::vector<Json> objects(const std::string& lines) {
  std::vector<Json> out;
  std::istringstream in(lines);
  for (std::string line; std::getline(in, line);) out.push_back(Json::parse(line));
  return out;
}

std::vector<std::uint64_t> seqs(const std::string& lines) {
  std::vector<std::uint64_t> out;
  for (const Json& object : objects(lines)) {
    if (object["class"] == "TENSOR") out.push_back(object["seq"].get<std::uint64_t>());
  }
  return out;
}

std::vector<std::uint64_t> range(std::uint64_t first, std::uint64_t last, std::uint64_t step = 1) {
  std::vector<std::uint64_t> out;
  for (std::uint64_t seq = first; seq <= last; seq += step) out.push_back(seq);
  return out;
}

std::string filled(Subscription& subscription, const SampleRing& ring) {
  std::string out;
  subscription.fill(ring, out, kNoLimit);
  return out;
}

TEST(Subscription, HearsNothingBeforeItAsksAndNothingFromBefore) {
  SampleRing ring(100);
  Subscription subscription;
  push_samples(ring, 0, 9);
  EXPECT_EQ(filled(subscription, ring), "");
  std::string out;
  subscription.watch(samples_from(std::nullopt), ring, out);
  EXPECT_EQ(out, "");
  push_samples(ring, 10, 12);
  EXPECT_EQ(seqs(filled(subscription, ring)), range(10, 12));
  EXPECT_EQ(filled(subscription, ring), "");
}

TEST(Subscription, TakesOnlyItsClasses) {
  SampleRing ring(100);
  Subscription subscription;
  std::string out;
  WatchRequest request{StreamClasses{}, std::nullopt, std::nullopt};
  request.classes.add(StreamClass::run);
  subscription.watch(request, ring, out);
  push_samples(ring, 0, 3);
  ring.push_gap(4, 5, R"({"class":"GAP"})");
  ring.push_other(StreamClass::status, R"({"class":"STATUS"})");
  ring.push_other(StreamClass::sensors, R"({"class":"SENSORS"})");
  ring.push_other(StreamClass::run, R"({"class":"RUN"})");
  EXPECT_EQ(filled(subscription, ring), "{\"class\":\"RUN\"}\n");
}

TEST(Subscription, EveryClassIsEveryOne) {
  SampleRing ring(100);
  Subscription subscription;
  std::string out;
  subscription.watch(WatchRequest{}, ring, out);
  std::string all;
  for (const StreamClass c : {StreamClass::status, StreamClass::run, StreamClass::sensors}) {
    const std::string line(kStreamClassNames.at(static_cast<std::size_t>(c)));
    ring.push_other(c, line);
    all += line + "\n";
  }
  EXPECT_EQ(filled(subscription, ring), all);
}

TEST(Subscription, EmptyWishStopsTheStream) {
  SampleRing ring(100);
  Subscription subscription;
  std::string out;
  subscription.watch(samples_from(std::nullopt), ring, out);
  push_samples(ring, 0, 3);
  subscription.watch(WatchRequest{StreamClasses{}, std::nullopt, std::nullopt}, ring, out);
  push_samples(ring, 4, 5);
  EXPECT_EQ(filled(subscription, ring), "");
}

struct Resume {
  std::uint64_t from_seq;
  std::optional<std::pair<std::uint64_t, std::uint64_t>> gap;
  std::uint64_t first;
};

// The ring holds samples 20 .. 29.
class ResumeTest : public ::testing::TestWithParam<Resume> {};

TEST_P(ResumeTest, GivesWhatIsHeldAndAGapForTheRest) {
  SampleRing ring(10);
  push_samples(ring, 0, 29);
  Subscription subscription;
  std::string out;
  subscription.watch(samples_from(GetParam().from_seq), ring, out);
  subscription.fill(ring, out, kNoLimit);
  push_samples(ring, 30, 31);
  subscription.fill(ring, out, kNoLimit);
  EXPECT_EQ(seqs(out), range(GetParam().first, 31));
  const Json first = objects(out).front();
  if (GetParam().gap) {
    EXPECT_EQ(first, Json({{"class", "GAP"},
                           {"from_seq", GetParam().gap->first},
                           {"to_seq", GetParam().gap->second},
                           {"why", "no longer held"}}));
  } else {
    EXPECT_EQ(first["class"], "TENSOR");
  }
}

using SeqRange = std::pair<std::uint64_t, std::uint64_t>;
INSTANTIATE_TEST_SUITE_P(FromSeq, ResumeTest,
                         ::testing::Values(Resume{0, SeqRange{0, 19}, 20}, Resume{19, SeqRange{19, 19}, 20},
                                           Resume{20, std::nullopt, 20}, Resume{25, std::nullopt, 25},
                                           Resume{29, std::nullopt, 29}, Resume{30, std::nullopt, 30}),
                         [](const auto& info) { return "from_" + std::to_string(info.param.from_seq); });

TEST(Subscription, ANumberFromAnotherLifeOfTheDaemonIsPointedOut) {
  SampleRing ring(10);
  push_samples(ring, 0, 3);
  Subscription subscription;
  std::string out;
  subscription.watch(samples_from(5000), ring, out);
  ASSERT_EQ(objects(out).size(), 1U);
  EXPECT_EQ(objects(out)[0]["class"], "ERROR");
  push_samples(ring, 4, 5);
  EXPECT_EQ(seqs(filled(subscription, ring)), range(4, 5));
}

TEST(Subscription, ResumeInsideAGapRepeatsTheGap) {
  SampleRing ring(10);
  push_samples(ring, 0, 2);
  ring.push_gap(3, 7, R"({"class":"GAP","from_seq":3,"to_seq":7,"why":"s2 silent"})");
  push_samples(ring, 8, 9);
  Subscription subscription;
  std::string out;
  subscription.watch(samples_from(5), ring, out);
  subscription.fill(ring, out, kNoLimit);
  EXPECT_EQ(objects(out).front()["why"], "s2 silent");
  EXPECT_EQ(seqs(out), range(8, 9));
}

RingRecord sample_on_disk(std::uint64_t seq, const std::string& line, double t_s = 0) {
  return {RingRecord::Kind::sample, seq, seq, {Instant{from_seconds(t_s)}, {}}, line};
}

// The disk holds 5 .. 27 but for 12 .. 14, the ring 20 .. 29.
TEST(Subscription, ReadsTheDiskUntilTheRingHasTheRest) {
  SampleRing ring(10);
  push_samples(ring, 0, 29);
  Subscription subscription;
  std::string out;
  subscription.watch(samples_from(2), ring, out, 5);
  ASSERT_EQ(subscription.behind(), 5U);
  EXPECT_EQ(objects(out)[0],
            Json({{"class", "GAP"}, {"from_seq", 2}, {"to_seq", 4}, {"why", "no longer held"}}));
  out.clear();
  for (std::uint64_t seq = 5; subscription.behind(); seq += seq == 11 ? 4 : 1) {
    ASSERT_LT(seq, 28U);
    subscription.take(sample_on_disk(seq, Json{{"class", "TENSOR"}, {"seq", seq}}.dump()), ring, out);
  }
  subscription.fill(ring, out, kNoLimit);
  std::uint64_t next = 5;
  int gaps = 0;
  for (const Json& object : objects(out)) {
    const bool is_gap = object["class"] == "GAP";
    EXPECT_EQ(object[is_gap ? "from_seq" : "seq"], next);
    next = object[is_gap ? "to_seq" : "seq"].get<std::uint64_t>() + 1;
    gaps += is_gap ? 1 : 0;
    if (is_gap) {
      EXPECT_EQ(object["from_seq"], 12);
    }
  }
  EXPECT_EQ(next, 30U);
  EXPECT_EQ(gaps, 1);
}

TEST(Subscription, ADiskThatEndsEarlyIsAGapUpToTheRing) {
  SampleRing ring(10);
  push_samples(ring, 0, 29);
  Subscription subscription;
  std::string out;
  subscription.watch(samples_from(5), ring, out, 0);
  subscription.take(sample_on_disk(5, R"({"class":"TENSOR","seq":5})"), ring, out);
  subscription.catch_up(ring, out);
  EXPECT_FALSE(subscription.behind());
  subscription.fill(ring, out, kNoLimit);
  EXPECT_EQ(objects(out)[1]["from_seq"], 6);
  EXPECT_EQ(objects(out)[1]["to_seq"], 19);
  EXPECT_EQ(seqs(out).back(), 29U);
}

TEST(Subscription, ARateHoldsAcrossLivesWhoseClocksDiffer) {
  SampleRing ring(10, 1000);
  Subscription subscription;
  std::string out;
  WatchRequest request = samples_from(0);
  request.rate_hz = 10;
  subscription.watch(request, ring, out, 0);
  for (std::uint64_t seq = 0; seq < 200; ++seq) {
    const double t_s =
        static_cast<double>(seq % 100) / 50 + (seq < 100 ? 9000 : 3);  // the host was restarted
    subscription.take(sample_on_disk(seq, Json{{"class", "TENSOR"}, {"seq", seq}}.dump(), t_s), ring, out);
  }
  EXPECT_EQ(seqs(out), range(0, 199, 5));
}

TEST(Subscription, AClientOfThePastThatTakesNothingIsSeen) {
  SampleRing ring(10);
  push_samples(ring, 0, 29);
  Subscription subscription;
  std::string out;
  subscription.watch(samples_from(5), ring, out, 0);
  push_samples(ring, 30, 70);
  EXPECT_TRUE(subscription.stays_behind(ring));
}

TEST(Subscription, RateTakesEveryKthSampleByTime) {
  for (const auto& [rate_hz, step] : {std::pair{10.0, 5U}, {25.0, 2U}, {50.0, 1U}, {200.0, 1U}, {1.0, 50U}}) {
    SampleRing ring(1000);
    Subscription subscription;
    std::string out;
    WatchRequest request = samples_from(std::nullopt);
    request.rate_hz = rate_hz;
    subscription.watch(request, ring, out);
    // Samples jitter by 1 ms about their grid, as real arrival times do.
    for (std::uint64_t seq = 0; seq < 500; ++seq) {
      push_sample(ring, seq, static_cast<double>(seq) / 50 + (seq % 3 == 0 ? 1e-3 : -1e-3));
    }
    EXPECT_EQ(seqs(filled(subscription, ring)), range(0, 499, step)) << rate_hz;
  }
}

TEST(Subscription, ARateThatDividesNothingIsKeptOnAverage) {
  SampleRing ring(2000);
  Subscription subscription;
  std::string out;
  WatchRequest request = samples_from(std::nullopt);
  request.rate_hz = 30;
  subscription.watch(request, ring, out);
  push_samples(ring, 0, 999);  // 20 s
  EXPECT_NEAR(static_cast<double>(seqs(filled(subscription, ring)).size()), 600, 1);
}

TEST(Subscription, AfterAPauseTheRateStartsAnewInsteadOfCatchingUp) {
  SampleRing ring(1000);
  Subscription subscription;
  std::string out;
  WatchRequest request = samples_from(std::nullopt);
  request.rate_hz = 10;
  subscription.watch(request, ring, out);
  push_sample(ring, 0, 0);
  for (std::uint64_t seq = 1; seq <= 10; ++seq)
    push_sample(ring, seq, 100 + static_cast<double>(seq - 1) / 50);
  EXPECT_EQ(seqs(filled(subscription, ring)), (std::vector<std::uint64_t>{0, 1, 6}));
}

TEST(Subscription, OvertakenItIsToldWhatItLostAndGoesOnWithTheNewest) {
  SampleRing ring(10);
  Subscription subscription;
  std::string out;
  subscription.watch(samples_from(std::nullopt), ring, out);
  push_samples(ring, 0, 4);
  subscription.fill(ring, out, kNoLimit);
  push_samples(ring, 5, 30);
  const std::string after = filled(subscription, ring);
  ASSERT_EQ(objects(after).size(), 1U);
  EXPECT_EQ(objects(after)[0],
            Json({{"class", "GAP"}, {"from_seq", 5}, {"to_seq", 30}, {"why", "client too slow"}}));
  EXPECT_EQ(subscription.gaps(), 1U);
  EXPECT_FALSE(subscription.stays_behind(ring));
  push_samples(ring, 31, 33);
  EXPECT_EQ(seqs(filled(subscription, ring)), range(31, 33));
}

TEST(Subscription, EverySampleIsEitherDeliveredOrInAGap) {
  SampleRing ring(16);
  Subscription subscription;
  std::string out;
  subscription.watch(samples_from(std::nullopt), ring, out);
  std::uint64_t seq = 0;
  for (int round = 0; round < 200; ++round) {
    for (int i = 0; i < (round * 7) % 23; ++i) {
      if (round % 5 == 0 && i == 2) {
        ring.push_gap(seq, seq + 2, Json{{"class", "GAP"}, {"from_seq", seq}, {"to_seq", seq + 2}}.dump());
        seq += 3;
      } else {
        push_sample(ring, seq++, 0);
      }
    }
    subscription.fill(ring, out, out.size() + 60);  // a few lines only: it falls behind at times
  }
  subscription.fill(ring, out, kNoLimit);
  std::uint64_t next = 0;
  for (const Json& object : objects(out)) {
    const bool is_gap = object["class"] == "GAP";
    EXPECT_EQ(object[is_gap ? "from_seq" : "seq"], next);
    next = object[is_gap ? "to_seq" : "seq"].get<std::uint64_t>() + 1;
  }
  EXPECT_EQ(next, seq);
  EXPECT_GT(subscription.gaps(), 0U);
}

TEST(Subscription, OvertakenAgainAndAgainItHasStayedBehind) {
  SampleRing ring(10);
  Subscription subscription;
  std::string out;
  subscription.watch(samples_from(std::nullopt), ring, out);
  for (int strike = 1; strike <= Subscription::kStrikes; ++strike) {
    EXPECT_FALSE(subscription.stays_behind(ring));
    push_samples(ring, 0, 11);
    out = filled(subscription, ring);
  }
  EXPECT_TRUE(subscription.stays_behind(ring));
}

TEST(Subscription, OvertakenNowAndThenItStays) {
  SampleRing ring(10);
  Subscription subscription;
  std::string out;
  subscription.watch(samples_from(std::nullopt), ring, out);
  for (int i = 0; i < 10; ++i) {
    push_samples(ring, 0, 11);
    out = filled(subscription, ring);
    for (int quiet = 0; quiet < 3; ++quiet) {
      push_samples(ring, 0, 7);
      out = filled(subscription, ring);
    }
    EXPECT_FALSE(subscription.stays_behind(ring));
  }
}

TEST(Subscription, ADeadClientIsSeenWithoutItsHelp) {
  SampleRing ring(10);
  Subscription subscription;
  std::string out;
  subscription.watch(samples_from(std::nullopt), ring, out);
  push_samples(ring, 0, 39);
  EXPECT_FALSE(subscription.stays_behind(ring));
  push_samples(ring, 40, 40);
  EXPECT_TRUE(subscription.stays_behind(ring));
  Subscription silent;
  EXPECT_FALSE(silent.stays_behind(ring)) << "who asked for nothing owes nothing";
}

}  // namespace
}  // namespace mgtd::daemon::serve
