// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/course_text.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "proto/run_course.h"
#include "proto/run_log.h"

namespace mgtd::daemon::cli {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(CourseText, SaysWhatWasGainedAndWhatDisturbed) {
  EXPECT_EQ(course_text(to_json(RunCourse{})), "no run yet\n");
  RunCourse course;
  course.run_id = "monday";
  course.poses = {{1, CourseState::measured, {}}, {2, CourseState::next, {}}, {3, CourseState::planned, {}}};
  course.why_unknown = "too few";
  EXPECT_THAT(course_text(to_json(course)), HasSubstr("1 of 3 poses measured\n"));
  EXPECT_THAT(course_text(to_json(course)), HasSubstr("not known yet: too few\ndisturbances: none\n"));
  for (int n = 18; n <= 60; ++n) course.accuracy.push_back({n, {}, 9.0 / n});
  course.accuracy.back().fit.residual_nT = 0.0234;
  course.good_accuracy = "the curve ends low.";
  course.disturbances = {{.pose = 2,
                          .change_nT = 12.5,
                          .limit_nT = 0.5,
                          .seen_by = "array",
                          .lasted_s = 7.2,
                          .then = "pose 2 is measured again"}};
  const std::string text = course_text(to_json(course));
  EXPECT_THAT(text, HasSubstr("     18 poses  0.5 nT/m\n")) << text;
  EXPECT_THAT(text, HasSubstr("     60 poses  0.15 nT/m, residual 0.0234 nT\n")) << text;
  EXPECT_THAT(text, HasSubstr("pose 2: 12 nT (limit 0.5 nT), 7 s; pose 2 is measured again\n")) << text;
}

TEST(CourseText, SaysHowWellEveryParameterIsKnown) {
  RunCourse course;
  course.run_id = "monday";
  course.good_accuracy = "the curve ends low.";
  course.parameters = {{"s1 ix", "nT"}, {"s1 kx", ""}, {"s2 ix", "nT"}, {"s2 kx", ""}};
  course.accuracy = {{.poses = 18}, {.poses = 40, .fit = {.parameter_sd = {0.25, 12e-6, 0.5, 8e-6}}}};
  EXPECT_THAT(course_text(to_json(course)), HasSubstr("standard errors of the parameters after 40 poses:\n"
                                                      "         unit       s1       s2\n"
                                                      "  ix       nT     0.25      0.5\n"
                                                      "  kx      ppm       12        8\n"));
  course.accuracy.push_back({.poses = 41});  // without a fit
  EXPECT_THAT(course_text(to_json(course)), Not(HasSubstr("standard errors of the parameters")));
}

TEST(CourseText, SaysWhatTheRunWroteDown) {
  EXPECT_EQ(events_text(to_json(RunLog{})), "no run yet\n");
  EXPECT_EQ(events_text(to_json(RunLog{.run_id = "monday"})), "run monday\n  nothing out of the ordinary\n");
  const RunLog log{.run_id = "monday", .left_out = 7, .entries = {{{0}, "s1 is back"}}};
  EXPECT_EQ(events_text(to_json(log)),
            "run monday\n7 earlier entries are in the run file only\n  1970-01-01T00:00:00Z  s1 is back\n");
}

}  // namespace
}  // namespace mgtd::daemon::cli
