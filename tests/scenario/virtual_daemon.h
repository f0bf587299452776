// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "daemon/acquire/calibrated_with.h"
#include "daemon/acquire/instrument_watch.h"
#include "tests/scenario/virtual_core.h"

/// The whole daemon in virtual time: poses are kept in memory, the fit is the test's.
namespace mgtd::test {

inline constexpr double kStep_s = 0.005;

class VirtualDaemon : public VirtualCore {
 public:
  /// `mistake`: what is wrong in the configuration, and what stands there instead.
  explicit VirtualDaemon(const rig::Scenario& scenario, std::pair<std::string, std::string> mistake = {})
      : VirtualCore(scenario, kStep_s), mistake_(std::move(mistake)) {
    restart();
  }

  PoseTable poses;
  std::optional<daemon::run::Finish> finished;
  std::optional<RunStatus> status;
  std::vector<std::string> records;
  std::vector<std::string> notes;               ///< the warnings of the log
  std::vector<InstrumentIdentity> instruments;  ///< of the run, as its file keeps them
  std::function<Result<daemon::run::Solution>(const PoseTable&)> solver = [](const PoseTable&) {
    return daemon::run::Solution{true, "cal", {}, {}};
  };
  /// Of a run that goes on until it is explained.
  std::function<daemon::run::FurtherPoses(const PoseTable&)> judge = [](const PoseTable&) {
    return daemon::run::FurtherPoses{};
  };
  std::function<void(const EpochOrGap&)> on_item = [](const EpochOrGap&) {};  ///< of the stream
  std::uint64_t gaps{0};

  [[nodiscard]] WallTime started_utc() const { return started_utc_; }
  [[nodiscard]] daemon::run::RunConfig run_config() {
    daemon::run::RunConfig out = daemon::run::run_config(config(), table().limits());
    out.run_id = "virtual";
    return out;
  }
  void start(daemon::plan::RunPlan plan, std::optional<daemon::run::RunConfig> config = std::nullopt,
             const std::optional<daemon::run::EarlierLife>& earlier = std::nullopt) {
    if (!earlier) started_utc_ = now().wall;
    finished.reset();
    core().run().begin(config ? *std::move(config) : run_config(), std::move(plan), now(), earlier);
  }
  [[nodiscard]] const daemon::plan::RunPlan& plan() { return core().run().fsm()->plan(); }
  void tell(const daemon::run::Event& event) { core().run().feed(event, now()); }
  /// The program ends in good order: the instruments hear its last words, the run is left as it is.
  void terminate() {
    core().abandon_run(now());
    close_ports();
    restart();
  }
  /// The program dies without a word and is started again; the instruments go on as they were.
  void restart() { start_program(config_text()); }
  /// Until `done` or the run's end; false after limit_s.
  bool run(
      double limit_s, const std::function<bool()>& done = [] { return false; }) {
    for (const double end_s = t_s + limit_s; t_s < end_s;) {
      if (finished || done()) return true;
      step();
    }
    return finished.has_value() || done();
  }

 private:
  [[nodiscard]] std::string config_text() const {
    std::string text = rig::config_text(rig.world().scenario(), "/dev", "/nowhere", 1, "127.0.0.1:0");
    const auto& [right, wrong] = mistake_;
    for (std::size_t at = 0; !right.empty() && (at = text.find(right, at)) != std::string::npos;
         at += wrong.size())
      text.replace(at, right.size(), wrong);
    return text;
  }

  void record(const RawRecord&) override {}
  void publish(const Epoch& epoch, const TensorSample&, std::span<const InputValue>) override {
    // As the samples say it of a calibration that was made with the instruments of this run.
    for (int i = 0; i < static_cast<int>(epoch.y_nT.size()); ++i)
      run_instruments_.answers({Slot::sensor(i).name(), health(static_cast<std::size_t>(i)).identity});
    Epoch seen = epoch;
    if (run_instruments_.another()) seen.flags |= Flag::identity;
    on_item(seen);
  }
  void publish(const Gap& gap) override {
    gaps += gap.to_seq - gap.from_seq + 1;
    on_item(gap);
  }
  void say(const daemon::core::Remark& remark, Instant) override {
    if (remark.level == daemon::core::Remark::Level::warning)
      notes.push_back(remark.topic + ": " + remark.text);
  }

  void carry_out(const daemon::run::Action& action, Stamp) override {
    std::visit([this](const auto& a) { act(a); }, action);
  }
  template <class OfTheCoreOrOfNoInterest>
  void act(const OfTheCoreOrOfNoInterest&) {}
  void act(const daemon::run::StorePose& store) {
    poses.poses.push_back(store.pose);
    core().run().answer(daemon::run::PoseStored{store.pose.number, {}});
  }
  void act(const daemon::run::StartSolve&) { core().run().answer(daemon::run::SolveDone{solver(poses)}); }
  void act(const daemon::run::StorePath& store) {
    for (const TableReading& r : store.readings)
      poses.path.push_back({static_cast<double>(r.arrival.wall.ns - started_utc_.ns) * 1e-9, r.angles});
  }
  void act(const daemon::run::JudgeRun&) { core().run().answer(judge(poses)); }
  void act(const daemon::run::ProposeCalibration&) {
    core().run().answer(daemon::run::CalibrationProposed{});
  }
  void act(const daemon::run::PublishStatus& publish) { status = publish.status; }
  void act(const daemon::run::Record& record) { records.push_back(record.what); }
  void act(const daemon::run::Finish& finish) { finished = finish; }
  void act(const daemon::run::StoreChecks& store) {
    if (store.stage != daemon::acquire::kInstrumentsStage) return;
    instruments = daemon::acquire::instruments_among(store.checks);
    run_instruments_.want(instruments);
  }

  std::pair<std::string, std::string> mistake_;
  daemon::acquire::InstrumentWatch run_instruments_{daemon::acquire::kByRun};
  WallTime started_utc_;
};

}  // namespace mgtd::test
