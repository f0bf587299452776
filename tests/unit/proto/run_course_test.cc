// SPDX-License-Identifier: Apache-2.0
#include "proto/run_course.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

namespace mgtd {
namespace {

TEST(RunCourse, WithoutARunIsEmptyAndHasEveryKey) {
  EXPECT_EQ(
      to_json(RunCourse{}).dump(),
      R"({"run_id":"","coverage":{"pose":[],"state":[],"direction":[],"hole":null,"good":null},)"
      R"("accuracy":{"poses":[],"worst_nT_per_m":[],"xx":[],"yy":[],"zz":[],"xy":[],"xz":[],"yz":[],)"
      R"("residual_nT":[],"offset_sd_nT":[],"scale_sd_ppm":[],"angle_sd_deg":[],)"
      R"("parameters":{"name":[],"unit":[],"sd":[]},)"
      R"("wanted_nT_per_m":null,"why":null,"expected":{"poses":[],"worst_nT_per_m":[]},"good":null},"disturbances":[]})");
}

TEST(RunCourse, HasItsDocumentedForm) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  RunCourse course;
  course.run_id = "monday";
  course.poses = {{1, CourseState::measured, Eigen::Vector3d(1, 2, -2) / 3}, {2, CourseState::next, {}}};
  course.hole = CourseHole{{0, 0, 1}, std::numbers::pi / 2};
  course.accuracy = {{18, {1, 2, 3, 4, kNone, 6}, 6, {.residual_nT = 0.5, .scale_sd = 0.25}}};
  course.expected = {{24, {}, 5}};
  course.wanted_nT_per_m = 2.5;
  course.good_coverage = "no hole.";
  course.disturbances = {{.t = WallTime{1'795'255'200'000'000'000},
                          .pose = 2,
                          .change_nT = 12.5,
                          .limit_nT = 0.5,
                          .seen_by = "array",
                          .lasted_s = {},
                          .then = "waits"}};
  const auto written = to_json(course);
  EXPECT_EQ(written["coverage"].dump(),
            R"({"pose":[1,2],"state":["measured","next"],"direction":[[0.3333,0.6667,-0.6667],null],)"
            R"("hole":{"direction":[0.0,0.0,1.0],"radius_deg":90.0},"good":"no hole."})");
  EXPECT_EQ(
      written["accuracy"].dump(),
      R"({"poses":[18],"worst_nT_per_m":[6.0],"xx":[1.0],"yy":[2.0],"zz":[3.0],"xy":[4.0],"xz":[null],)"
      R"("yz":[6.0],"residual_nT":[0.5],"offset_sd_nT":[null],"scale_sd_ppm":[250000.0],"angle_sd_deg":[null],)"
      R"("parameters":{"name":[],"unit":[],"sd":[null]},)"
      R"("wanted_nT_per_m":2.5,"why":null,"expected":{"poses":[24],"worst_nT_per_m":[5.0]},"good":null})");
  EXPECT_EQ(written["disturbances"].dump(),
            R"([{"t":"2026-11-21T10:00:00.000000Z","pose":2,"change_nT":12.5,"limit_nT":0.5,)"
            R"("seen_by":"array","lasted_s":null,"then":"waits"}])");
}

TEST(RunCourse, ParametersAreNamedOnceAndHaveAnArrayForEachFit) {
  RunCourse course;
  course.parameters = {{"s1 theta", "deg", 50}, {"s1 cx", "", 1}};
  course.accuracy = {{18, {}, 6, {.parameter_sd = {0.04, 0.123456}}},
                     {19, {}, 5, {}},
                     {20, {}, 4, {.parameter_sd = {0.02, 0.1}}}};
  EXPECT_EQ(to_json(course)["accuracy"]["parameters"].dump(),
            R"({"name":["s1 theta","s1 cx"],"unit":["deg",""],"sd":[[2.0,0.1235],null,[1.0,0.1]]})");
  keep_last_parameters(course);
  EXPECT_EQ(to_json(course)["accuracy"]["parameters"]["sd"].dump(), "[null,null,[1.0,0.1]]");
  RunCourse none;
  keep_last_parameters(none);
  EXPECT_TRUE(none.accuracy.empty());
}

}  // namespace
}  // namespace mgtd
