// SPDX-License-Identifier: Apache-2.0
#include "proto/sensors_report.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "proto/stream_codec.h"
#include "proto/units.h"

namespace mgtd {
namespace {

SensorsReport two_sensors() {
  SensorsReport out{.from_seq = 100,
                    .to_seq = 149,
                    .t = WallTime{1'795'255'200'123'456'000},
                    .calibration = "c0123456789ab",
                    .table = TableAngles{to_rad(30), to_rad(-5), 0},
                    .sensors = PerSensor<SensorMean>(2)};
  SensorMean& s1 = out.sensors[0];
  s1.epochs = 50;
  s1.y_nT = {1.5, -2.25, 49'999.1250004};
  s1.sd_nT = {0.25, 0.5, 0.125};
  s1.b_P_nT = {3, 0, 4};
  s1.T_degC = 23.5;
  return out;
}

TEST(SensorsReport, HasItsDocumentedForm) {
  EXPECT_EQ(encode(two_sensors()),
            R"({"class":"SENSORS","from_seq":100,"to_seq":149,"t":"2026-11-21T10:00:00.123456Z",)"
            R"("t_ns":1795255200123456000,"frame":"platform","cal":"c0123456789ab",)"
            R"("table":{"azimuth_deg":30.0,"pitch_deg":-5.0,"roll_deg":0.0},"sensors":[)"
            R"({"name":"s1","epochs":50,"raw_nT":[1.5,-2.25,49999.125],"sd_nT":[0.25,0.5,0.125],)"
            R"("b_nT":[3.0,0.0,4.0],"f_nT":5.0,"T_degC":23.5},)"
            R"({"name":"s2","epochs":0,"raw_nT":null,"sd_nT":null,"b_nT":null,"f_nT":null,"T_degC":null}]})");
}

TEST(SensorsReport, WhatIsNotKnownIsNull) {
  SensorsReport raw = two_sensors();
  raw.calibration.reset();
  raw.table.reset();
  const auto line = to_json(raw);
  EXPECT_TRUE(line["cal"].is_null());
  EXPECT_TRUE(line["table"].is_null());
}

}  // namespace
}  // namespace mgtd
