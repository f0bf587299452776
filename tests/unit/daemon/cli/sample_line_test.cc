// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/sample_line.h"

#include <gmock/gmock.h>

namespace mgtd::daemon::cli {
namespace {

using nlohmann::json;
using ::testing::EndsWith;

json cross() {
  return json::parse(R"({"class":"TENSOR","t":"2026-11-21T10:00:00.123456Z","cal":"c0123456789ab",
    "b_nT":[20000.5,-3.25,43000.125],"f_nT":47423.456,
    "g_nT_per_m":{"xx":1.5,"yy":-2.5,"zz":1.0,"xy":0.25,"xz":null,"yz":12.0},
    "g_sd_nT_per_m":{"xx":0.1,"yy":0.1,"zz":0.14,"xy":0.1,"xz":null,"yz":0.1},"flags":[]})");
}

json without_gradient() {
  json out = cross();
  for (auto& component : out["g_nT_per_m"]) component = nullptr;
  for (auto& sd : out["g_sd_nT_per_m"]) sd = nullptr;
  return out;
}

TEST(SampleLine, HasTheGradientAndItsLargestStandardDeviation) {
  EXPECT_EQ(sample_line(cross()),
            "10:00:00.123  F   47423.46 nT  G xx     1.50 yy    -2.50 zz     1.00 xy     0.25 xz       -- yz "
            "   12.00 each to +-0.14 or better nT/m  cal c0123456789ab");
}

TEST(SampleLine, SaysThatThereIsNoCalibrationAndWhatIsWrong) {
  json sample = cross();
  sample["cal"] = nullptr;
  for (auto& sd : sample["g_sd_nT_per_m"]) sd = nullptr;
  sample["flags"] = {"uncalibrated", "moving"};
  EXPECT_THAT(sample_line(sample), EndsWith("yz    12.00 nT/m  cal none uncalibrated moving"));
}

TEST(SampleLine, OfOneSensorHasTheField) {
  EXPECT_EQ(sample_line(without_gradient()),
            "10:00:00.123  F   47423.46 nT  B x   20000.50 y      -3.25 z   43000.12 nT  cal c0123456789ab");
  json unknown = without_gradient();
  unknown["b_nT"] = {nullptr, nullptr, nullptr};
  unknown["f_nT"] = nullptr;
  EXPECT_EQ(sample_line(unknown).size(), sample_line(without_gradient()).size());
}

TEST(SampleLine, OfSensorsOnALineHasTheDerivativeAlongIt) {
  json pair = without_gradient();
  pair["along_line_nT_per_m"] = {12.5, -3.125, 0.0};
  pair["along_line_sd_nT_per_m"] = {0.1, 0.25, 0.1};
  EXPECT_THAT(sample_line(pair),
              ::testing::HasSubstr("nT  G along the line x    12.50 y    -3.12 z     0.00 each to +-0.25 or "
                                   "better nT/m  cal"));
  const std::size_t length = sample_line(pair).size();
  pair["along_line_nT_per_m"] = {-112.5, 3.125, 10.0};
  EXPECT_EQ(sample_line(pair).size(), length);  // below those of the line before
  pair["along_line_sd_nT_per_m"] = {nullptr, nullptr, nullptr};
  EXPECT_THAT(sample_line(pair), EndsWith("z    10.00 nT/m  cal c0123456789ab"));
}

}  // namespace
}  // namespace mgtd::daemon::cli
