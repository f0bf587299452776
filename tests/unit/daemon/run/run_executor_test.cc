// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/run_executor.h"

#include <gtest/gtest.h>

#include <future>

#include "tests/unit/daemon/temp_dir.h"

namespace mgtd::daemon::run {
namespace {

/// An executor whose fits wait for their turn on the worker, and then only note whether they were told to
/// stop.
struct HeldFit {
  explicit HeldFit(const RunRequest& request = {}) {
    worker.run(
        [open = gate.get_future()](std::stop_token) mutable {
          open.wait();
          return 0;
        },
        [](int) {});
    EXPECT_TRUE(executor.start(request, now));
  }
  ~HeldFit() { let_it_begin(); }
  void let_it_begin() {
    if (!std::exchange(opened, true)) gate.set_value();
    io.run();
  }
  RunHooks hooks() {
    return {.limits = [this]() -> const drivers::TableLimits& { return limits; },
            .table =
                [] {
                  LinkHealth health;
                  health.state = LinkState::live;
                  return health;
                },
            .publish = [](const RunStatus&) {},
            .warn = [](std::string_view, const std::string&, Instant) {},
            .solve = [this](const std::filesystem::path&,
                            const std::stop_token& stop) -> Result<calib::fit::FitReport> {
              ++fits;
              stopped = stop.stop_requested();
              return fail(ErrorCode::refused, "not fitted here", "");
            }};
  }

  test::TempDir dir;
  Stamp now{Instant{}, WallTime{1'795'255'200'000'000'000}};
  drivers::TableLimits limits{.azimuth = {-7, 7}, .pitch = {-4, 4}, .roll = {-4, 4}};
  config::Config config;
  store::CalibrationStore store = store::CalibrationStore::open(dir / "calibrations").value();
  boost::asio::io_context io{1};
  std::promise<void> gate;
  bool opened{false}, stopped{false};  ///< read here when io.run() has returned
  int fits{0};
  store::Worker worker{io};
  CurrentRun run{[](const Action&, Stamp) {}};
  RunExecutor executor{config, dir / "", store, worker, run, hooks()};
};

/// Another daemon on the files of this one.
struct Later {
  explicit Later(HeldFit& held)
      : before(held),
        executor(before.config, before.dir / "", before.store, before.worker, run, before.hooks()) {
    before.executor.abandon();
    executor.find_interrupted();
  }
  ~Later() { before.let_it_begin(); }  // its jobs answer it
  HeldFit& before;
  CurrentRun run{[](const Action&, Stamp) {}};
  RunExecutor executor;
};

TEST(RunExecutor, TellsWhatTheRunWroteDown) {
  HeldFit held;
  held.executor.carry_out(Record{"s1 is back"}, held.now);
  const auto log = held.executor.log();
  ASSERT_TRUE(log) << log.error().text();
  EXPECT_FALSE(log->run_id.empty());
  ASSERT_FALSE(log->entries.empty());
  EXPECT_EQ(log->entries.back().what, "s1 is back");
  EXPECT_EQ(log->entries.back().t, held.now.wall);
}

TEST(RunExecutor, AFitThatNobodyCancelsIsNotStopped) {
  HeldFit held;
  held.executor.carry_out(StartSolve{}, held.now);
  held.let_it_begin();
  EXPECT_EQ(held.fits, 1);
  EXPECT_FALSE(held.stopped);
}

TEST(RunExecutor, ACancelledFitIsToldToStop) {
  HeldFit held;
  held.executor.carry_out(StartSolve{}, held.now);
  held.executor.carry_out(CancelSolve{}, held.now);
  held.let_it_begin();
  EXPECT_EQ(held.fits, 1);
  EXPECT_TRUE(held.stopped);
}

TEST(RunExecutor, TheCourseFollowsWhatTheRunAsksFor) {
  HeldFit held;
  const std::size_t planned = held.run.fsm()->plan().poses.size();
  EXPECT_EQ(held.executor.course().poses.size(), planned);
  Pose pose;
  pose.number = 1;
  pose.azimuth_rad = pose.pitch_rad = pose.roll_rad = 0;
  pose.y_nT.fill(Eigen::Vector3d(20'000, 0, 45'000));
  held.executor.carry_out(StorePose{pose}, held.now);
  held.executor.carry_out(FieldDisturbed{2, {.change_nT = 3, .limit_nT = 0.5}}, held.now);
  RunCourse course = held.executor.course();
  EXPECT_EQ(course.poses.at(0).state, CourseState::measured);
  EXPECT_TRUE(course.poses.at(1).direction_P);
  ASSERT_EQ(course.disturbances.size(), 1u);
  held.executor.carry_out(DropPoses{{1}}, held.now);
  EXPECT_NE(held.executor.course().poses.at(0).state, CourseState::measured);
}

/// What the daemon knew of a run when it ended is there again when the run is resumed.
TEST(RunExecutor, AResumedRunHasItsCourseAgain) {
  HeldFit held;
  Pose pose;
  pose.number = 1;
  pose.azimuth_rad = pose.pitch_rad = pose.roll_rad = 0;
  pose.y_nT.fill(Eigen::Vector3d(20'000, 0, 45'000));
  held.executor.carry_out(StorePose{pose}, held.now);
  held.executor.carry_out(FieldDisturbed{2, {.change_nT = 3, .limit_nT = 0.5}}, held.now);
  RunStatus measuring;
  measuring.state = RunState::suspended;
  held.executor.carry_out(PublishStatus{measuring}, held.now);
  const std::string id = held.executor.course().run_id;

  Later later(held);
  const auto resumed = later.executor.request(Request::resume, held.now);
  ASSERT_TRUE(resumed) << resumed.error().text();
  const RunCourse course = later.executor.course();
  EXPECT_EQ(course.run_id, id);
  EXPECT_EQ(course.poses.at(0).state, CourseState::measured);
  ASSERT_EQ(course.disturbances.size(), 1U);
  EXPECT_EQ(course.disturbances[0].change_nT, 3);
  EXPECT_EQ(course.disturbances[0].then, "the daemon ended before the field was calm");
}

TEST(RunExecutor, APlanWithTooFewSamplesInADwellIsRefused) {
  HeldFit held;
  EXPECT_TRUE(held.executor.plan({}));
  held.config.rate_hz = 1;
  EXPECT_FALSE(held.executor.plan({}));
}

TEST(RunExecutor, AResumedRunKeepsItsRetries) {
  HeldFit held({.retries = 7});
  EXPECT_EQ(held.run.fsm()->config().retries, 7);
  RunStatus measuring;
  measuring.state = RunState::dwelling;
  held.executor.carry_out(PublishStatus{measuring}, held.now);
  Later later(held);
  ASSERT_TRUE(later.executor.request(Request::resume, held.now));
  EXPECT_EQ(later.run.fsm()->config().retries, 7);
}

TEST(RunExecutor, ARunThatCannotBeginLeavesTheFailedOneToBeResumed) {
  HeldFit held;
  held.executor.carry_out(Finish{RunState::failed, "s2 did not come back"}, held.now);
  Later later(held);
  EXPECT_EQ(later.executor.status(held.now.mono).state, RunState::failed);
  ASSERT_FALSE(later.executor.start({}, held.now)) << "its file exists already";
  EXPECT_EQ(later.executor.status(held.now.mono).state, RunState::failed);
  EXPECT_TRUE(later.executor.request(Request::resume, held.now));
}

/// The clock that names the files may have been ahead during the run before.
TEST(RunExecutor, TheLastRunIsTakenUpWhateverTheClockSaidBefore) {
  HeldFit held;
  held.executor.carry_out(Finish{RunState::done, "proposed"}, held.now);
  const Stamp year_before{held.now.mono, WallTime{held.now.wall.ns - std::int64_t{365} * 86'400'000'000'000}};
  Later later(held);
  const auto begun = later.executor.start({}, year_before);
  ASSERT_TRUE(begun) << begun.error().text();
  later.executor.carry_out(Finish{RunState::failed, "s2 did not come back"}, year_before);
  Later after_that(held);
  EXPECT_EQ(after_that.executor.status(year_before.mono).state, RunState::failed);
  EXPECT_EQ(after_that.executor.status(year_before.mono).run_id, later.executor.course().run_id);
}

}  // namespace
}  // namespace mgtd::daemon::run
