// SPDX-License-Identifier: Apache-2.0
#include "daemon/app/calibration_history.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/support/sealed_calibration.h"
#include "tests/unit/daemon/temp_dir.h"

namespace mgtd::daemon::app {
namespace {

using mgtd::testing::sealed_calibration;
using ::testing::HasSubstr;

WallTime hour(int h) { return {1'795'255'200'000'000'000 + h * 3'600'000'000'000LL}; }

struct Kept {
  test::TempDir dir;
  store::CalibrationStore store{store::CalibrationStore::open(dir / "cal").value()};
  CalibrationHistory history{store};

  std::string propose(const std::string& t_utc, int h) {
    const auto c = sealed_calibration(t_utc);
    EXPECT_TRUE(store.propose(c, "run " + t_utc, hour(h)));
    return c.id;
  }
};

TEST(CalibrationHistory, TellsWhoDecidedWhatAndWhy) {
  Kept kept;
  const std::string id = kept.propose("2026-03-02T08:00:00Z", 0);
  ASSERT_TRUE(kept.store.accept(id, hour(1), false, "quiet night", "anna"));
  const auto told = kept.history.report();
  ASSERT_EQ(told.at("decisions").size(), 2U);
  EXPECT_EQ(told.at("decisions").at(0).at("by"), "automatic");
  EXPECT_EQ(told.at("decisions").at(1).at("by"), "anna");
  EXPECT_EQ(told.at("decisions").at(1).at("why"), "quiet night");
  EXPECT_TRUE(told.at("moves").empty());
  EXPECT_TRUE(told.at("figure").is_null()) << "one calibration has not moved";
}

/// What was rejected is no neighbour, as soon as it is rejected.
TEST(CalibrationHistory, GoesFromEachToTheNextThatWasNotRejected) {
  Kept kept;
  const std::string a = kept.propose("2026-03-02T08:00:00Z", 0), b = kept.propose("2026-05-11T08:00:00Z", 1);
  EXPECT_EQ(kept.history.report().at("moves").at(0).at("to"), b);
  const std::string c = kept.propose("2026-09-20T08:00:00Z", 2);
  EXPECT_EQ(kept.history.report().at("moves").size(), 2U);
  ASSERT_TRUE(kept.store.reject(b, "a car", hour(3)));
  const auto told = kept.history.report();
  ASSERT_EQ(told.at("moves").size(), 1U);
  EXPECT_EQ(told.at("moves").at(0).at("from"), a);
  EXPECT_EQ(told.at("moves").at(0).at("to"), c);
  EXPECT_THAT(told.at("figure").at("svg").get<std::string>(), HasSubstr("2026-09-20"));
}

TEST(CalibrationHistory, ADamagedFileIsNamedAndPassedOver) {
  Kept kept;
  kept.propose("2026-03-02T08:00:00Z", 0);
  const std::string b = kept.propose("2026-05-11T08:00:00Z", 1);
  kept.propose("2026-09-20T08:00:00Z", 2);
  std::filesystem::resize_file(kept.dir / "cal" / (b + ".json"), 100);
  const auto told = kept.history.report();
  EXPECT_EQ(told.at("unreadable"), nlohmann::ordered_json::array({b}));
  EXPECT_EQ(told.at("moves").size(), 1U);
}

/// The answer has an end, however many calibrations there are, and it is the newest that it tells.
TEST(CalibrationHistory, AnswersWithTheLatestOfVeryMany) {
  Kept kept;
  std::string last;
  for (int i = 0; i < 40; ++i)
    last = kept.propose(fmt::format("2026-03-{:02}T{:02}:00:00Z", 1 + i / 20, i % 20), i);
  const auto told = kept.history.report();
  EXPECT_EQ(told.at("decisions").size(), 40U);
  EXPECT_EQ(told.at("moves").size(), 25U);
  EXPECT_EQ(told.at("moves").back().at("to"), last);
  EXPECT_LT(told.dump().size(), 1'000'000U);
}

}  // namespace
}  // namespace mgtd::daemon::app
