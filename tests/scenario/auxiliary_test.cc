// SPDX-License-Identifier: Apache-2.0
// A current near the array, from the input module to the poses, the model and the corrected stream.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "calib/effects/library/library.h"
#include "calib/fit/method_choice/fit.h"
#include "calib/report/fit_reasons.h"
#include "daemon/acquire/live_pipeline.h"
#include "tests/scenario/virtual_daemon.h"

namespace mgtd {
namespace {

using namespace mgtd::daemon;
using test::VirtualDaemon;

constexpr const char* kScenario =
    "[rig]\nname = 'lamp'\nparameters = 'table6'\nseed = 9\n"
    "[[covariate]]\nname = 'lamp_A'\nmean = 2\namplitude = 1\nevery_s = 40\n"
    "[[effect]]\nname = 'platform.current'\nwhere = 's2'\nof = 'lamp_A'\nnT_per_A = [4, -3, 6]\n";

/// Readings of an array at rest, 50 a second, from `from_s` on; what the stream says of the last one.
TensorSample last_of(daemon::acquire::LivePipeline& pipeline, const Pose& pose, double from_s) {
  std::optional<TensorSample> last;
  for (std::uint64_t k = 0; k < 400; ++k) {
    const double t_s = from_s + 0.02 * static_cast<double>(k);
    for (int slot = 0; slot < kSensors; ++slot) {
      FieldReading reading;
      reading.slot = slot;
      reading.seq = static_cast<std::uint64_t>(std::lround(t_s / 0.02));
      reading.arrival = {Instant{from_seconds(t_s)}, WallTime{pose.t_utc->ns + from_seconds(t_s).count()}};
      reading.y_nT = pose.y_nT[static_cast<std::size_t>(slot)];
      pipeline.push(reading);
    }
    pipeline.advance(Instant{from_seconds(t_s)});
    pipeline.deliver([&](const Epoch&, const TensorSample& sample, bool) { last = sample; },
                     [](const Gap&) {});
  }
  return last.value_or(TensorSample{});
}

TEST(Auxiliary, ACurrentIsMeasuredFittedAndTakenOutOfTheStream) {
  VirtualDaemon daemon(test::scenario_of(kScenario));
  std::shared_ptr<const calib::calibration::Calibration> calibration;
  daemon.solver = [&](const PoseTable& poses) -> Result<daemon::run::Solution> {
    calib::fit::FitOptions options;
    options.effects = {*calib::effects::library::make_effect("platform.current@s2")};
    auto fitted = calib::fit::method_choice::fit(poses, options);
    if (!fitted) return tl::unexpected(fitted.error());
    calibration = std::make_shared<const calib::calibration::Calibration>(fitted->calibration);
    return daemon::run::Solution{
        calibration->accepted_by_checks, calibration->id, calib::report::fit_reasons(*fitted), {}};
  };
  ASSERT_TRUE(daemon.run(60, [&] { return daemon.all_live(); })) << daemon.health(6).detail;
  daemon.start(*daemon::plan::make_plan({}, daemon.table().limits()));
  ASSERT_TRUE(daemon.run(4 * 3600)) << daemon.status->message;
  ASSERT_EQ(name(daemon.finished->state), "done") << daemon.finished->message;
  for (const Pose& pose : daemon.poses.poses) {
    const double lamp_A = pose.covariates.at("lamp_A");
    EXPECT_TRUE(lamp_A >= 0.999 && lamp_A <= 3.001) << lamp_A;
  }

  // 157 means of 0.03 nT over +-1 A tell a coefficient to 0.003 nT/A; what toggles within a dwell adds to it.
  ASSERT_NE(calibration, nullptr);
  ASSERT_EQ(calibration->effects.size(), 1U);
  const std::array<double, 3> truth{4, -3, 6};
  // The published table's axes are not the array's: lengths compare in every frame.
  double found = 0, wanted = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    found += std::pow(calibration->effects[0].coefficients[k].value, 2);
    wanted += std::pow(truth[k], 2);
  }
  EXPECT_NEAR(std::sqrt(found), std::sqrt(wanted), 0.1);

  // The stream takes it out while it is told of the current, and says so when it is not.
  const Pose& pose = daemon.poses.poses.front();
  daemon::acquire::LivePipeline pipeline({}, calib::sensor::Geometry());
  pipeline.use(calibration);
  EXPECT_TRUE(last_of(pipeline, pose, 0).flags.has(Flag::incomplete)) << "nobody has told the current";
  const auto lamp = [](double t_s, double current_A) {
    return AuxiliaryReading{{Instant{from_seconds(t_s)}, {}}, {{"lamp_A", current_A}}};
  };
  pipeline.push(lamp(8, pose.covariates.at("lamp_A")));
  const TensorSample right = last_of(pipeline, pose, 8);
  EXPECT_FALSE(right.flags.has(Flag::incomplete));
  EXPECT_NEAR(right.f_nT, daemon.rig.world().scenario().f_nT, 5);
  pipeline.push(lamp(16, pose.covariates.at("lamp_A") + 1));
  const TensorSample other = last_of(pipeline, pose, 16);
  // One sensor of four is corrected by the length of [4, -3, 6] more, over the baseline of 0.4 m.
  const double change_nT =
      0.4 * std::hypot(other.g_nT_per_m.yy - right.g_nT_per_m.yy, other.g_nT_per_m.xy - right.g_nT_per_m.xy,
                       other.g_nT_per_m.yz - right.g_nT_per_m.yz);
  EXPECT_GT(change_nT, 0.3 * std::sqrt(wanted));
  EXPECT_LT(change_nT, 3 * std::sqrt(wanted));
  EXPECT_TRUE(last_of(pipeline, pose, 200).flags.has(Flag::incomplete)) << "what it was 180 s ago is not now";
}

/// The same current through an input of a digitiser: means of every pose are those of the rig's own truth.
TEST(Auxiliary, InputsOfTheDigitisersAreColumnsOfEveryPose) {
  VirtualDaemon daemon(test::scenario_of(
      "[rig]\nname = 'motor'\nparameters = 'table6'\nseed = 9\n"
      "[[covariate]]\nname = 'motor_A'\nwave = 'ramp'\namplitude = 1\nevery_s = 3600\n"
      "input = 's3.q'\nunit = 'A'\nper_V = 2\nat_0V = -0.5\n"
      "[[covariate]]\nname = 'supply_V'\nmean = 12\namplitude = 0.3\nwave = 'sine'\nevery_s = 4000\n"
      "input = 's1.r'\nper_V = 5\n"));
  ASSERT_TRUE(daemon.run(60, [&] { return daemon.all_live(); }));
  daemon.start(
      *daemon::plan::make_plan({.step_deg = 20, .random = 12, .revisits = 2}, daemon.table().limits()));
  const double begun_s = daemon.t_s;
  ASSERT_TRUE(daemon.run(3600)) << daemon.status->message;
  ASSERT_EQ(name(daemon.finished->state), "done") << daemon.finished->message;
  ASSERT_EQ(daemon.poses.poses.size(), 30U);
  const auto& covariates = daemon.rig.world().scenario().covariates;
  for (const Pose& pose : daemon.poses.poses) {
    ASSERT_EQ(pose.covariates.size(), 2U);
    // Read once a second, at steps of 1/8000 V, within half a second of the middle of the dwell.
    EXPECT_NEAR(pose.covariates.at("motor_A"), covariates[0].at(begun_s + *pose.t_s),
                2 / 8000.0 + 0.5 / 3600);
    EXPECT_NEAR(pose.covariates.at("supply_V"), covariates[1].at(begun_s + *pose.t_s), 5 / 8000.0 + 5e-4);
    EXPECT_TRUE(pose.T_degC[0]) << "the thermometers are read as before";
  }
}

}  // namespace
}  // namespace mgtd
