// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "calib/sensor/sensor_equations.h"
#include "daemon/run/run_fsm.h"

/// A run in virtual time on a rig of a few lines: a table that moves and lies on request, four sensors that
/// feel the field turn, a scalar reference, a disk that can be full. Every action is checked against what a
/// run promises, whatever the test does to it.
namespace mgtd::test {

using namespace mgtd::daemon;

inline drivers::TableLimits bench_limits() {
  return {{to_rad(-180), to_rad(180)}, {to_rad(-90), to_rad(90)}, {to_rad(-180), to_rad(180)}};
}

inline daemon::run::RunConfig bench_config() {
  daemon::run::RunConfig c;
  c.run_id = "bench";
  c.fewest_poses = 2;
  c.limits = bench_limits();
  c.preflight.rate_hz = c.settle.rate_hz = c.dwell.rate_hz = 10;
  c.preflight.scalar = true;
  c.pace.velocity_rad_per_s = to_rad(30);
  return c;
}

inline daemon::plan::RunPlan bench_plan(int poses) {
  daemon::plan::RunPlan plan;
  for (int i = 0; i < poses; ++i) {
    plan.poses.push_back({i + 1,
                          i < 2 ? "standard" : "random",
                          {to_rad(40.0 * (i + 1)), to_rad(i < 2 ? 0 : 10), to_rad(i < 2 ? 0 : -20)},
                          2,
                          i < 2 ? 1 : 0,
                          {}});
  }
  return plan;
}

struct FakeTable {
  TableAngles at, target;
  bool moving{false}, referenced{false}, homing{false}, stuck{false};
  double velocity_rad_per_s{to_rad(30)};

  void advance(double dt_s) {
    if (!moving || stuck) return;
    double left = 0;
    for (const auto axis : {&TableAngles::azimuth_rad, &TableAngles::pitch_rad, &TableAngles::roll_rad}) {
      const double d =
          std::clamp(target.*axis - at.*axis, -velocity_rad_per_s * dt_s, velocity_rad_per_s * dt_s);
      at.*axis += d;
      left = std::max(left, std::abs(target.*axis - at.*axis));
    }
    if (left > 0) return;
    moving = false;
    referenced = referenced || std::exchange(homing, false);
  }
  void go(TableAngles to) {
    target = to;
    moving = true;
  }
  void stop() { moving = homing = false; }
};

class RunBench {
 public:
  explicit RunBench(daemon::plan::RunPlan plan, daemon::run::RunConfig config = bench_config(),
                    const std::optional<daemon::run::EarlierLife>& earlier = std::nullopt)
      : limits(config.limits), fsm(std::move(config), std::move(plan), now(), earlier) {}

  static constexpr double kTick_s = 0.05;

  /// From one state to the next, as all runs of this process have shown them.
  static std::set<std::pair<RunState, RunState>>& transitions() {
    static std::set<std::pair<RunState, RunState>> seen;
    return seen;
  }

  FakeTable table;
  std::set<Slot> lost;       ///< devices whose port is gone
  std::set<Slot> silent;     ///< devices that say nothing
  PerSensor<bool> frozen{};  ///< sensors that repeat their last value
  bool saturated{false};
  double disturbance_nT{0};
  bool disk_full{false}, disk_stalls{false}, propose_fails{false}, solve_stalls{false};
  std::function<Result<daemon::run::Solution>()> solver = [] {
    return daemon::run::Solution{true, "cal-1", {}, {}};
  };

  /// What the run is told when its plan is measured; the looks so far.
  std::function<daemon::run::FurtherPoses(int)> judge = [](int) {
    return daemon::run::FurtherPoses{{.found = "PASS", .next = "nothing is left to explain"}, {}};
  };
  bool judge_stalls{false};
  std::vector<daemon::run::StoreJudgement> judgements;

  std::vector<daemon::run::FieldDisturbed> disturbed;
  std::vector<daemon::run::Action> log;
  std::vector<Pose> stored;
  std::vector<TableAngles> moves;
  std::optional<daemon::run::Finish> finished;
  std::optional<RunStatus> status;
  std::vector<RunState> states;       ///< without repetition
  TableAngles mounting;               ///< of the array on the table, as it truly is
  std::optional<TableAngles> really;  ///< where a table turned by hand truly stands
  int dropped{0};
  int proposals{0}, stops{0}, solves{0}, events{0};
  bool aborted{false};
  drivers::TableLimits limits;
  double t_s{0};
  double clock_set_s{0};  ///< by so much the wall clock was set forward

  [[nodiscard]] Stamp now() const {
    return {Instant{from_seconds(1000 + t_s)},
            WallTime{1'800'000'000'000'000'000 + from_seconds(t_s + clock_set_s).count()}};
  }

  void send(const daemon::run::Event& event) {
    ++events;
    if (std::holds_alternative<daemon::run::Request>(event) &&
        std::get<daemon::run::Request>(event) == daemon::run::Request::abort)
      aborted = true;
    for (daemon::run::Action& action : fsm.step(event, now())) {
      EXPECT_FALSE(finished) << "an action after the last one";
      std::visit([this](auto& a) { carry_out(a); }, action);
      log.push_back(std::move(action));
    }
  }

  /// One step of virtual time: the rig first, then what it says, then the answers that are due.
  void tick() {
    t_s += kTick_s;
    ++ticks_;
    table.advance(kTick_s);
    answer();
    if (ticks_ % 2 == 0) sample();
    if (ticks_ % 2 == 1 && says(Slot::table())) send(reading());
    if (ticks_ % 20 == 5 && says(Slot::scalar()))
      send(ScalarReading{now(), 50000 + noise() * 0.05, 99, true});
    if (ticks_ % 20 == 7) {
      for (std::size_t number = 0; number <= Slot::scalar().number(); ++number) {
        const Slot slot = Slot::numbered(number);
        LinkHealth health;
        health.state = says(slot) ? LinkState::live : LinkState::silent;
        send(daemon::run::LinkSeen{slot, health});
      }
    }
    send(daemon::run::Tick{});
  }
  /// Until `done` or the end of the run, at most `limit_s` of virtual time.
  bool run(
      double limit_s, const std::function<bool()>& done = [] { return false; }) {
    const double end_s = t_s + limit_s;
    while (t_s < end_s) {
      if (finished || done()) return true;
      tick();
    }
    return finished.has_value() || done();
  }
  bool run_to(RunState state, double limit_s = 600) {
    return run(limit_s, [&] { return status && status->state == state; });
  }
  void lose(Slot slot) {
    lost.insert(slot);
    send(daemon::run::DeviceLost{slot, "the port is gone"});
  }
  void give_back(Slot slot) {
    lost.erase(slot);
    send(daemon::run::DeviceBack{slot});
  }
  [[nodiscard]] bool says(Slot slot) const { return !lost.contains(slot) && !silent.contains(slot); }
  [[nodiscard]] TableReading reading() const {
    return {now(), table.at, table.referenced, table.moving, !table.moving};
  }

  daemon::run::RunFsm fsm;

 private:
  void carry_out(const daemon::run::HomeTable&) {
    EXPECT_FALSE(storing_) << "the table moves before the pose is stored";
    if (lost.contains(Slot::table())) return;
    table.referenced = false;
    table.homing = true;
    table.go({});
  }
  void carry_out(const daemon::run::MoveTable& move) {
    EXPECT_FALSE(storing_) << "the table moves before the pose is stored";
    EXPECT_FALSE(aborted) << "the table moves after an abort";
    EXPECT_TRUE(lost.empty()) << "the table moves while a device is lost";
    EXPECT_TRUE(table.referenced) << "a move without reference";
    const auto in = [](const drivers::TableLimits::Range& r, double a) {
      return a >= r.min_rad - 1e-9 && a <= r.max_rad + 1e-9;
    };
    EXPECT_TRUE(in(limits.azimuth, move.target.azimuth_rad) && in(limits.pitch, move.target.pitch_rad) &&
                in(limits.roll, move.target.roll_rad));
    moves.push_back(move.target);
    table.go(move.target);
  }
  void carry_out(const daemon::run::SetTable& set) {
    EXPECT_FALSE(storing_) << "the table moves before the pose is stored";
    table.at = set.angles;
    table.moving = false;
  }
  void carry_out(const daemon::run::DropPoses& drop) {
    dropping_ = drop.numbers;
    if (disk_full) return;
    dropped += static_cast<int>(drop.numbers.size());
    std::erase_if(stored, [&](const Pose& p) {
      return std::find(drop.numbers.begin(), drop.numbers.end(), p.number) != drop.numbers.end();
    });
  }
  void carry_out(const daemon::run::StopTable&) {
    ++stops;
    if (!lost.contains(Slot::table())) table.stop();
  }
  void carry_out(daemon::run::StorePose& store) {
    EXPECT_FALSE(storing_);
    EXPECT_FALSE(table.moving) << "a pose measured on the move";
    if (!store.pose.mount) {
      EXPECT_NEAR(store.pose.azimuth_rad.value_or(-99), table.at.azimuth_rad, 1e-6);
    }
    storing_ = store.pose;
    answer_at_s_ = t_s + 0.12;
  }
  void carry_out(const daemon::run::StartSolve&) {
    ++solves;
    EXPECT_FALSE(table.moving);
    solve_at_s_ = t_s + 0.5;
  }
  void carry_out(const daemon::run::JudgeRun&) {
    EXPECT_FALSE(table.moving);
    judge_at_s_ = t_s + 0.5;
  }
  void carry_out(const daemon::run::StoreJudgement& store) { judgements.push_back(store); }
  void carry_out(const daemon::run::CancelSolve&) {}
  void carry_out(const daemon::run::ProposeCalibration&) {
    EXPECT_FALSE(aborted);
    ++proposals;
    propose_at_s_ = t_s + 0.1;
  }
  void carry_out(const daemon::run::PublishStatus& publish) {
    if (status && status->state != publish.status.state)
      transitions().emplace(status->state, publish.status.state);
    status = publish.status;
    if (states.empty() || states.back() != status->state) states.push_back(status->state);
    EXPECT_FALSE(status->message.empty());
    if (status->state == RunState::paused && !lost.contains(Slot::table())) {
      EXPECT_FALSE(table.moving) << "paused on the move";
    }
  }
  void carry_out(const daemon::run::Finish& finish) {
    finished = finish;
    EXPECT_FALSE(is_active(finish.state));
    EXPECT_FALSE(finish.message.empty());
    EXPECT_TRUE(!table.moving || lost.contains(Slot::table()));
    if (finish.state != RunState::done) {
      EXPECT_TRUE(status->proposed.empty());
    }
  }
  void carry_out(const daemon::run::StorePath&) {}
  void carry_out(const daemon::run::StoreChecks&) {}
  void carry_out(const daemon::run::FieldDisturbed& seen) { disturbed.push_back(seen); }
  void carry_out(const daemon::run::Record&) {}

  void answer() {
    if (!dropping_.empty()) send(daemon::run::PosesDropped{std::exchange(dropping_, {}), disk_answer()});
    if (storing_ && !disk_stalls && t_s >= answer_at_s_) {
      const int number = storing_->number;
      if (!disk_full) {
        for (const Pose& p : stored) EXPECT_NE(p.number, number) << "stored twice";
        stored.push_back(*storing_);
      }
      storing_.reset();
      send(daemon::run::PoseStored{number, disk_answer()});
    }
    if (solve_at_s_ && !solve_stalls && t_s >= *solve_at_s_) {
      solve_at_s_.reset();
      send(daemon::run::SolveDone{solver()});
    }
    if (judge_at_s_ && !judge_stalls && t_s >= *judge_at_s_) {
      judge_at_s_.reset();
      send(judge(static_cast<int>(judgements.size())));
    }
    if (propose_at_s_ && t_s >= *propose_at_s_) {
      propose_at_s_.reset();
      send(daemon::run::CalibrationProposed{
          propose_fails ? fail(ErrorCode::io, "no space left on device", "free some space")
                        : Result<void>{}});
    }
  }

  [[nodiscard]] Result<void> disk_answer() const {
    return disk_full ? fail(ErrorCode::io, "no space left on device", "free some space") : Result<void>{};
  }

  void sample() {
    const std::uint64_t seq = seq_++;
    for (int i = 0; i < kSensors; ++i) {
      if (const Slot sensor = Slot::sensor(i); !says(sensor)) {
        send(Gap{seq, seq, now(), sensor.name() + " silent"});
        return;
      }
    }
    Epoch epoch;
    epoch.seq = seq;
    epoch.t = now();
    if (saturated) epoch.flags |= Flag::saturated;
    const auto turned = [](const TableAngles& a) {
      return calib::sensor::table_rotation(a.azimuth_rad, a.pitch_rad, a.roll_rad, 0.0, 0.0);
    };
    const Eigen::Vector3d b_nT = turned(mounting) * (turned(really.value_or(table.at)) *
                                                     (50000 * Eigen::Vector3d(1, 0.1, 1.2).normalized()));
    for (std::size_t i = 0; i < kSensors; ++i) {
      const double moved_nT = disturbance_nT * std::sin(7 * t_s);
      last_nT_[i] = frozen[i]
                        ? last_nT_[i]
                        : b_nT + Eigen::Vector3d(noise() + moved_nT, noise() + moved_nT, noise() + moved_nT);
      epoch.y_nT[i] = last_nT_[i];
      epoch.T_degC[i] = 20;
    }
    send(epoch);
  }
  /// Sum of twelve uniforms: mean 0, sd 1.
  double noise() {
    double sum = -6;
    for (int i = 0; i < 12; ++i) sum += static_cast<double>(engine_() >> 11U) * 0x1p-53;
    return sum;
  }

  std::mt19937_64 engine_{7};
  std::uint64_t seq_{0};
  int ticks_{0};
  PerSensor<Eigen::Vector3d> last_nT_{};
  std::optional<Pose> storing_;
  std::vector<int> dropping_;
  double answer_at_s_{0};
  std::optional<double> judge_at_s_, solve_at_s_, propose_at_s_;
};

}  // namespace mgtd::test
