// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/watch_panel.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace mgtd::daemon::cli {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

json sample() {
  return json::parse(R"({"class":"TENSOR","seq":5210,"t":"2026-11-21T10:00:00.123456Z","cal":"c0123456789ab",
    "b_nT":[20000.5,-3.25,43000.125],"f_nT":47423.456,
    "g_nT_per_m":{"xx":1.5,"yy":-2.5,"zz":1.0,"xy":0.25,"xz":null,"yz":12.0},
    "g_sd_nT_per_m":{"xx":0.1,"yy":0.1,"zz":0.14,"xy":0.1,"xz":null,"yz":0.1},
    "closure":{"chi2":3.14},"flags":[]})");
}

json status(const std::string& t) {
  json out = json::parse(R"({"class":"STATUS","criticism":{"state":"ok","measured":"","limit":"","remedy":""},
    "devices":[{"name":"s1","state":"live","detail":""},
               {"name":"s2","state":"silent","detail":"no byte for 12 s"}],"run":{}})");
  out["t"] = t;
  out["array"] = {{"closure_limit", 18.467}};
  return out;
}

TEST(WatchPanel, SaysThatNothingCameYet) { EXPECT_EQ(WatchPanel().text(80), "sample    none yet\n"); }

TEST(WatchPanel, ShowsTheLastSampleWithItsStandardDeviations) {
  WatchPanel panel;
  panel.take(sample());
  EXPECT_EQ(panel.text(80),
            "sample    2026-11-21 10:00:00.123 UTC, number 5210\n"
            "calibr.   c0123456789ab\n"
            "field     F 47423.46 nT\n"
            "          x 20000.50, y -3.25, z 43000.12 nT\n"
            "nT/m              xx        yy        zz        xy        xz        yz\n"
            "gradient        1.50     -2.50      1.00      0.25        --     12.00\n"
            "std. dev.       0.10      0.10      0.14      0.10        --      0.10\n"
            "closure   chi-square 3.1\n"
            "flags     none\n");
}

TEST(WatchPanel, NamesTheDeviceThatIsLostAndWhatItMissed) {
  WatchPanel panel;
  panel.take(sample());
  panel.take(status("2026-11-21T10:00:00.200000Z"));
  panel.take({{"class", "GAP"}, {"from_seq", 5300}, {"to_seq", 5325}, {"why", "s2: silent"}});
  const std::string text = panel.text(80);
  EXPECT_THAT(text, HasSubstr("closure   chi-square 3.1 (limit 18.5)\n"));
  EXPECT_THAT(text, HasSubstr("judged    ok\n"));
  EXPECT_THAT(text, HasSubstr("devices   s1 live, s2 silent\n          s2: no byte for 12 s\n"));
  EXPECT_THAT(text, HasSubstr("missed    26 epochs; the last: s2: silent\n"));
  EXPECT_THAT(text, Not(HasSubstr("none has come")));
}

TEST(WatchPanel, AnOldSampleSaysHowOldItIs) {
  WatchPanel panel;
  panel.take(sample());
  panel.take(status("2026-11-21T10:00:12.123456Z"));
  EXPECT_THAT(panel.text(80), HasSubstr("none has come since, for 12 s"));
}

TEST(WatchPanel, AnArrayWithoutAGradientShowsTheField) {
  json one = sample();
  for (auto& value : one["g_nT_per_m"]) value = nullptr;
  WatchPanel panel;
  panel.take(one);
  EXPECT_THAT(panel.text(80), HasSubstr("F 47423.46 nT"));
  EXPECT_THAT(panel.text(80), Not(HasSubstr("gradient")));
}

TEST(WatchPanel, SensorsOnALineShowTheDerivativeAlongIt) {
  json pair = sample();
  for (auto& component : pair["g_nT_per_m"]) component = nullptr;
  pair["along_line_nT_per_m"] = {12.5, -3.125, 0.0};
  pair["along_line_sd_nT_per_m"] = {nullptr, nullptr, nullptr};
  EXPECT_EQ(along_line_text(pair), "x 12.50, y -3.12, z 0.00 nT/m along the line");
  pair["along_line_sd_nT_per_m"] = {0.1, 0.25, 0.1};
  WatchPanel panel;
  panel.take(pair);
  EXPECT_THAT(
      panel.text(80),
      HasSubstr("\ngradient  x 12.50, y -3.12, z 0.00 nT/m along the line, each to +-0.25 or better\n"));
  pair["g_nT_per_m"]["xx"] = 12.5;
  panel.take(pair);
  EXPECT_THAT(panel.text(80), Not(HasSubstr("along the line")));
  EXPECT_EQ(along_line_text(sample()), "");
}

TEST(WatchPanel, ASuspectCalibrationSaysWhatWasMeasuredAndWhatToDo) {
  json doubtful = status("2026-11-21T10:00:00Z");
  doubtful["criticism"] = {{"state", "suspect"},
                           {"measured", "the closure follows T1"},
                           {"limit", "p 1e-4"},
                           {"remedy", "calibrate"}};
  WatchPanel panel;
  panel.take(doubtful);
  EXPECT_THAT(panel.text(80),
              HasSubstr("judged    suspect\n          the closure follows T1\n          limit: p 1e-4\n"
                        "          calibrate\n"));
}

/// A panel as high as the terminal scrolls, and the cursor comes back to the wrong line.
TEST(WatchPanel, NoMoreIsDrawnThanTheTerminalHolds) {
  const std::string panel = "a\nb\nc\nd\ne\n";
  EXPECT_EQ(top_of(panel, 6), panel);
  EXPECT_EQ(top_of(panel, 5), "a\nb\nc\n... 2 lines more\n");
  EXPECT_EQ(top_of(panel, 3), "a\n... 4 lines more\n");
}

TEST(WatchPanel, TheCursorGoesBackOverWhatWasDrawn) {
  EXPECT_EQ(back_over(0), "\x1b[J");
  EXPECT_EQ(back_over(9), "\r\x1b[9A\x1b[J");
}

}  // namespace
}  // namespace mgtd::daemon::cli
