// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/meant_calibration.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace mgtd::daemon::cli {
namespace {

using ::testing::HasSubstr;

const nlohmann::json& three() {
  static const auto kThree = nlohmann::json::parse(R"([
    {"id":"c12ab00000000","state":"active","since":"2026-11-20T10:00:00Z"},
    {"id":"c12cd00000000","state":"proposed","since":"2026-11-22T10:00:00Z"},
    {"id":"c99ef00000000","state":"proposed","since":"2026-11-21T10:00:00Z"}])");
  return kThree;
}

TEST(MeantCalibration, AnIdOrTheBeginningOfOne) {
  EXPECT_EQ(*meant_calibration("c12ab00000000", three()), "c12ab00000000");
  EXPECT_EQ(*meant_calibration("c9", three()), "c99ef00000000");
}

TEST(MeantCalibration, LatestIsTheNewestProposal) {
  EXPECT_EQ(*meant_calibration("latest", three()), "c12cd00000000");
  EXPECT_EQ(meant_calibration("latest", nlohmann::json::array()).error().code, ErrorCode::state);
}

TEST(MeantCalibration, ABeginningOfTwoNamesBoth) {
  const auto meant = meant_calibration("c12", three());
  ASSERT_FALSE(meant);
  EXPECT_THAT(meant.error().message, HasSubstr("c12ab00000000, c12cd00000000"));
}

TEST(MeantCalibration, AnUnknownOneIsRefusedWithTheNearest) {
  EXPECT_THAT(meant_calibration("c99ef00000001", three()).error().message,
              HasSubstr("did you mean 'c99ef00000000'?"));
  EXPECT_FALSE(meant_calibration("", three()));
}

}  // namespace
}  // namespace mgtd::daemon::cli
