// SPDX-License-Identifier: Apache-2.0
#include "proto/tensor_encoder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>
#include <vector>

namespace mgtd {
namespace {

using Json = nlohmann::json;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TensorSample sample() {
  TensorSample s;
  s.seq = 123;
  s.t.wall.ns = 1'795'255'200'123'456'000;
  s.calibration_id = std::make_shared<const std::string>("c0123456789ab");
  s.b_P_nT = {1.5, -2.25, 49'999.125};
  s.f_nT = 50'000;
  s.g_nT_per_m = {10.5, -20.25, 9.75, 1, -2, 3};
  s.g_sd_nT_per_m = {0.25, 0.25, 0.5, 0.125, 0.125, 0.125};
  s.closure.curl_nT_per_m = 0.5;
  s.closure.center_nT = {1, 2, -3};
  s.closure.chi2 = 3.875;
  s.flags = Flags(Flag::interpolated) | Flag::suspect;
  return s;
}

TEST(TensorEncoder, WritesExactlyTheDocumentedKeys) {
  TensorEncoder encoder;
  EXPECT_EQ(
      encoder.encode(sample()),
      R"({"class":"TENSOR","seq":123,"t":"2026-11-21T10:00:00.123456Z","t_ns":1795255200123456000,)"
      R"("frame":"platform","cal":"c0123456789ab","b_nT":[1.500000,-2.250000,49999.125000],)"
      R"("f_nT":50000.000000,"g_nT_per_m":{"xx":10.500000,"yy":-20.250000,"zz":9.750000,"xy":1.000000,)"
      R"("xz":-2.000000,"yz":3.000000},"g_sd_nT_per_m":{"xx":0.250000,"yy":0.250000,"zz":0.500000,)"
      R"("xy":0.125000,"xz":0.125000,"yz":0.125000},"invariants":{"I1_nT2_per_m2":-321.687500,)"
      R"("I2_nT3_per_m3":-2108.343750,"contraction_nT_per_m":25.364838},"closure":{"curl_nT_per_m":0.500000,)"
      R"("center_nT":[1.000000,2.000000,-3.000000],"chi2":3.875000},"flags":["interpolated","suspect"]})");
}

TEST(TensorEncoder, AnotherArrayHasItsOwnClosureAndNullForWhatItCannotTell) {
  TensorSample s = sample();
  s.g_nT_per_m = s.g_sd_nT_per_m = {kNaN, kNaN, 1.5, kNaN, -2, 3};
  s.closure.curl_nT_per_m = kNaN;
  s.closure.center_nT.setConstant(kNaN);
  s.closure.combinations_nT = Eigen::Vector2d(0.25, -1);
  s.closure.dof = 2;
  TensorEncoder encoder;
  const Json line = Json::parse(encoder.encode(s));
  EXPECT_EQ(line["g_nT_per_m"],
            Json::parse(R"({"xx":null,"yy":null,"zz":1.5,"xy":null,"xz":-2.0,"yz":3.0})"));
  EXPECT_TRUE(line["invariants"].is_null());
  EXPECT_EQ(line["closure"], Json::parse(R"({"curl_nT_per_m":null,"center_nT":null,"chi2":3.875,"dof":2,)"
                                         R"("combinations_nT":[0.25,-1.0]})"));
}

TEST(TensorEncoder, SensorsOnALineHaveTheDerivativeAlongIt) {
  TensorSample s = sample();
  s.along_line = LineDerivative{{1, -2, 0.5}, {0.25, 0.25, 0.5}};
  TensorEncoder encoder;
  const Json line = Json::parse(encoder.encode(s));
  EXPECT_EQ(line["along_line_nT_per_m"], Json::parse("[1.0,-2.0,0.5]"));
  EXPECT_EQ(line["along_line_sd_nT_per_m"], Json::parse("[0.25,0.25,0.5]"));
}

TEST(TensorEncoder, InputsStandBehindTheFlagsByTheirColumns) {
  const std::vector<InputValue> inputs{{"motor_A", 0.5}, {"supply_V", kNaN}};
  TensorEncoder encoder;
  const std::string line(encoder.encode(sample(), inputs));
  EXPECT_TRUE(
      line.ends_with(R"("flags":["interpolated","suspect"],"inputs":{"motor_A":0.500000,"supply_V":null}})"))
      << line;
  EXPECT_TRUE(Json::parse(line)["inputs"]["supply_V"].is_null());
}

TEST(TensorEncoder, WhatIsNotANumberIsNull) {
  TensorSample s = sample();
  s.calibration_id = nullptr;
  s.g_sd_nT_per_m = {kNaN, kNaN, kNaN, kNaN, kNaN, kNaN};
  s.closure.chi2 = kNaN;
  s.f_nT = std::numeric_limits<double>::infinity();
  s.g_nT_per_m.zz = kNaN;
  s.flags = {};
  TensorEncoder encoder;
  const Json line = Json::parse(encoder.encode(s));
  EXPECT_TRUE(line["cal"].is_null());
  EXPECT_TRUE(line["f_nT"].is_null());
  EXPECT_TRUE(line["g_nT_per_m"]["zz"].is_null());
  EXPECT_TRUE(line["closure"]["chi2"].is_null());
  for (const char* key : {"xx", "yy", "zz", "xy", "xz", "yz"})
    EXPECT_TRUE(line["g_sd_nT_per_m"][key].is_null());
  EXPECT_EQ(line["flags"], Json::array());
}

TEST(TensorEncoder, TimeIsUtcOnBothSidesOfTheEpochAndOfASecond) {
  TensorEncoder encoder;
  for (const std::int64_t ns :
       {std::int64_t{0}, std::int64_t{-1}, std::int64_t{-1'000'000'000}, std::int64_t{999'999'999},
        std::int64_t{1'000'000'000}, std::int64_t{1'795'255'199'999'999'999},
        std::int64_t{951'782'400'000'001'000}}) {
    TensorSample s = sample();
    s.t.wall.ns = ns;
    const Json line = Json::parse(encoder.encode(s));
    EXPECT_EQ(line["t"], format_utc(WallTime{ns}));
    EXPECT_EQ(line["t_ns"], ns);
  }
}

// Half a micro-unit is what six decimals leave; the sum of three printed numbers is exact to double rounding.
TEST(TensorEncoder, NumbersComeBackAndTheTraceStaysZero) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> magnitude(-12, 5);
  std::uniform_int_distribution<int> sign(0, 1);
  const auto draw = [&] { return (sign(random) == 0 ? 1 : -1) * std::pow(10.0, magnitude(random)); };
  TensorEncoder encoder;
  for (int i = 0; i < 2000; ++i) {
    TensorSample s = sample();
    s.b_P_nT = {draw(), draw(), draw()};
    s.g_nT_per_m = {draw(), draw(), 0, draw(), draw(), draw()};
    s.g_nT_per_m.zz = -(s.g_nT_per_m.xx + s.g_nT_per_m.yy);
    const Json line = Json::parse(encoder.encode(s));
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(line["b_nT"][static_cast<std::size_t>(axis)].get<double>(), s.b_P_nT[axis], 0.5000001e-6);
    }
    const Json& g = line["g_nT_per_m"];
    EXPECT_NEAR(g["zz"].get<double>(), s.g_nT_per_m.zz, 1.0000001e-6);
    EXPECT_NEAR(g["xx"].get<double>() + g["yy"].get<double>() + g["zz"].get<double>(), 0.0, 1e-10);
  }
}

TEST(TensorEncoder, HugeNumbersAreStillNumbersAndAWrongTraceIsNotHidden) {
  TensorSample s = sample();
  s.f_nT = 1.5e300;
  s.b_P_nT.x() = -4e12;
  s.g_nT_per_m = {1, 2, 5, 0, 0, 0};
  TensorEncoder encoder;
  const Json line = Json::parse(encoder.encode(s));
  EXPECT_EQ(line["f_nT"], 1.5e300);
  EXPECT_EQ(line["b_nT"][0], -4e12);
  EXPECT_EQ(line["g_nT_per_m"]["zz"], 5.0);
}

}  // namespace
}  // namespace mgtd
