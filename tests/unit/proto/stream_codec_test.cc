// SPDX-License-Identifier: Apache-2.0
#include "proto/stream_codec.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "proto/status_codec.h"

namespace mgtd {
namespace {

using Json = nlohmann::json;

RunStatus run_status() {
  RunStatus run;
  run.run_id = "2026-11-21T10-00-00";
  run.state = RunState::dwelling;
  run.set = "random";
  run.pose = 70;
  run.poses = 157;
  run.retries = 2;
  run.elapsed_s = 512.5;
  run.remaining_s = 250;
  run.tensor_sd_nT_per_m = 1.25;
  run.message = "pose 71: dwelling";
  run.checks = {{"rate s1", true, "50.0 Hz", "50 Hz", ""},
                {"noise s3", false, "2 nT", "1 nT", "look for iron"}};
  return run;
}

bool operator==(const Check& a, const Check& b) {
  return a.name == b.name && a.passed == b.passed && a.measured == b.measured && a.limit == b.limit &&
         a.remedy == b.remedy;
}

TEST(StreamCodec, GreetingGapAndErrorHaveTheirDocumentedForm) {
  const ArrayDescription pair{.positions_P_m = {Eigen::Vector3d(0, 0, 0.25), Eigen::Vector3d(0, 0, -0.25)},
                              .gradient = {"zz", "xz"},
                              .line = {},
                              .closure = 0,
                              .tells = "field and a derivative"};
  EXPECT_EQ(encode(Greeting{"rig 7", "mgtd 0.1.0", pair}),
            R"({"class":"HELLO","protocol":{"major":1,"minor":2},"rig":"rig 7","software":"mgtd 0.1.0",)"
            R"("array":{"sensors":2,"positions_m":[[0.0,0.0,0.25],[0.0,0.0,-0.25]],"gradient":["zz","xz"],)"
            R"("line":null,"closure":0,"closure_limit":null,"tells":"field and a derivative"}})");
  EXPECT_EQ(encode(Gap{4, 9, {}, "s2 silent"}),
            R"({"class":"GAP","from_seq":4,"to_seq":9,"why":"s2 silent"})");
  EXPECT_EQ(encode(Error{ErrorCode::bad_input, "a \"quote\"", "b"}),
            R"({"class":"ERROR","message":"a \"quote\"","remedy":"b"})");
}

TEST(StreamCodec, TextOfAnInstrumentCannotBreakALine) {
  const std::string line = encode(Greeting{"rig\n\xff\x01", "m"});
  EXPECT_EQ(line.find('\n'), std::string::npos);
  EXPECT_TRUE(Json::accept(line));
}

TEST(StreamCodec, RunComesBackWhole) {
  const RunStatus run = run_status();
  const Json object = Json::parse(encode(run));
  EXPECT_EQ(object["class"], "RUN");
  const auto back = run_status_from_json(object);
  ASSERT_TRUE(back) << back.error().text();
  EXPECT_EQ(back->run_id, run.run_id);
  EXPECT_EQ(back->state, run.state);
  EXPECT_EQ(back->set, run.set);
  EXPECT_EQ(back->pose, run.pose);
  EXPECT_EQ(back->poses, run.poses);
  EXPECT_EQ(back->retries, run.retries);
  EXPECT_EQ(back->elapsed_s, run.elapsed_s);
  EXPECT_EQ(back->remaining_s, run.remaining_s);
  EXPECT_EQ(back->tensor_sd_nT_per_m, 1.25);
  EXPECT_FALSE(back->wanted_tensor_sd_nT_per_m);
  EXPECT_FALSE(back->field_change);
  EXPECT_EQ(back->message, run.message);
  EXPECT_EQ(back->proposed, run.proposed);
  ASSERT_EQ(back->checks.size(), run.checks.size());
  for (std::size_t i = 0; i < run.checks.size(); ++i) EXPECT_TRUE(back->checks[i] == run.checks[i]);
}

TEST(StreamCodec, ARunThatWatchesTheFieldSaysHowFarItChanged) {
  RunStatus run = run_status();
  run.field_change = FieldChange{0.25, 0.5};
  Json object = Json::parse(encode(run));
  EXPECT_EQ(object["field_change"].dump(), R"({"change_nT":0.25,"limit_nT":0.5})");
  const auto back = run_status_from_json(object);
  ASSERT_TRUE(back && back->field_change);
  EXPECT_EQ(back->field_change->change_nT, 0.25);
  EXPECT_EQ(back->field_change->limit_nT, 0.5);
  object["field_change"].erase("limit_nT");
  EXPECT_NE(run_status_from_json(object).error().message.find("field_change: 'limit_nT'"), std::string::npos);
}

TEST(StreamCodec, EveryRunStateHasAName) {
  for (int i = 0; i <= static_cast<int>(RunState::interrupted); ++i) {
    RunStatus run = run_status();
    run.state = static_cast<RunState>(i);
    run.proposed = "c1";
    const auto back = run_status_from_json(Json::parse(encode(run)));
    ASSERT_TRUE(back);
    EXPECT_EQ(back->state, run.state);
    EXPECT_EQ(back->proposed, "c1");
  }
}

TEST(StreamCodec, ARunThatIsNoneIsRefusedByKey) {
  const auto message = [](const char* key, const Json& value) {
    Json object = Json::parse(encode(run_status()));
    object[key] = value;
    if (value.is_discarded()) object.erase(key);
    const auto run = run_status_from_json(object);
    return run ? std::string("accepted") : run.error().message;
  };
  const Json erased(Json::value_t::discarded);
  EXPECT_NE(message("pose", erased).find("'pose' is missing"), std::string::npos);
  EXPECT_NE(message("pose", "x").find("'pose' is not a whole number"), std::string::npos);
  EXPECT_NE(message("state", "dancing").find("state 'dancing' is unknown"), std::string::npos);
  EXPECT_NE(message("checks", Json::array({7})).find("in checks"), std::string::npos);
  EXPECT_EQ(message("another", 1), "accepted");
  EXPECT_FALSE(run_status_from_json(Json::array()));
}

TEST(StreamCodec, StatusShowsTheBooksOfEveryDevice) {
  StatusReport report;
  report.at.mono = Instant{std::chrono::seconds(100)};
  report.at.wall.ns = 1'795'255'200'000'000'000;
  report.uptime_s = 12.5;
  report.software = "mgtd 0.1.0";
  report.rig = "rig 7";
  report.calibration = "c1";
  DeviceStatus device{"s1", "obsdaq", "/dev/mgt/s1", {}};
  device.health.state = LinkState::live;
  device.health.bytes_in = 100;
  device.health.bytes_in_frames = 80;
  device.health.reject(Reject::checksum, 20);
  device.health.last_frame = Instant{std::chrono::milliseconds(99'980)};
  device.health.state_since = Instant{std::chrono::seconds(40)};
  device.rate_hz = 49.9;
  report.calibration_use = {.forced = true,
                            .left_out = {{"axis.offset.drift", "t_s"}},
                            .age_s = 3600,
                            .made_at_degC = {12, std::nullopt},
                            .now_degC = {31.5, std::nullopt}};
  report.devices = {device, {"table", "gcs2", "/dev/mgt/table", {}}};
  report.devices[1].health.bytes_in = 1;
  report.inputs = {{"motor_A", "s2", "q", "A", 0.5, Instant{std::chrono::seconds(99)}},
                   {"wind", "aux1", "0", "", std::nullopt, std::nullopt}};
  report.sampler = {500, 3, 50.0, 1e-4};
  report.journal = {"stopped", "no space", 4096, 17, 1};
  report.run.remaining_s = std::numeric_limits<double>::quiet_NaN();

  const Json status = Json::parse(encode(report));
  EXPECT_EQ(status["class"], "STATUS");
  EXPECT_EQ(status["t"], "2026-11-21T10:00:00.000000Z");
  EXPECT_EQ(status["cal"], "c1");
  EXPECT_EQ(status["devices"][0]["state"], "live");
  EXPECT_EQ(
      status["devices"][0]["rejected"],
      Json({{"length", 0}, {"framing", 0}, {"checksum", 1}, {"number", 0}, {"range", 0}, {"sequence", 0}}));
  EXPECT_EQ(status["devices"][0]["balanced"], true);
  EXPECT_EQ(status["devices"][0]["last_frame_age_s"], 0.02);
  EXPECT_DOUBLE_EQ(status["devices"][0]["state_since_s"].get<double>(), 60);
  EXPECT_EQ(status["devices"][0]["rate_hz"], 49.9);
  EXPECT_TRUE(status["devices"][1]["state_since_s"].is_null());
  EXPECT_TRUE(status["devices"][1]["rate_hz"].is_null());
  EXPECT_EQ(status["calibration"],
            Json::parse(R"({"forced":true,"left_out":[{"effect":"axis.offset.drift","lacks":"t_s"}],)"
                        R"("age_s":3600.0,"made_at_degC":[12.0,null],"now_degC":[31.5,null]})"));
  EXPECT_TRUE(Json::parse(encode(StatusReport{}))["calibration"]["made_at_degC"].is_null());
  EXPECT_EQ(status["devices"][1]["balanced"], false);
  EXPECT_TRUE(status["devices"][1]["last_frame_age_s"].is_null());
  EXPECT_EQ(status["inputs"][0], Json({{"name", "motor_A"},
                                       {"device", "s2"},
                                       {"input", "q"},
                                       {"unit", "A"},
                                       {"value", 0.5},
                                       {"age_s", 1.0}}));
  EXPECT_TRUE(status["inputs"][1]["unit"].is_null());
  EXPECT_TRUE(status["inputs"][1]["value"].is_null());
  EXPECT_TRUE(status["inputs"][1]["age_s"].is_null());
  EXPECT_EQ(status["sampler"],
            Json({{"epochs", 500}, {"gaps", 3}, {"rate_hz", 50.0}, {"skew_bound_s", 1e-4}}));
  EXPECT_EQ(
      status["journal"],
      Json({{"state", "stopped"}, {"why", "no space"}, {"bytes", 4096}, {"bytes_lost", 17}, {"stops", 1}}));
  EXPECT_EQ(status["ring"]["state"], "off");
  EXPECT_TRUE(status["disk_free_bytes"].is_null());
  EXPECT_EQ(status["run"]["state"], "idle");
  EXPECT_TRUE(status["run"]["remaining_s"].is_null());
}

}  // namespace
}  // namespace mgtd
