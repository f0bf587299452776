// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/wiring_probe.h"

#include <fmt/format.h>

namespace mgtd::daemon::run {
namespace {

PerSensor<std::string> names_of_places(const calib::sensor::Geometry& array) {
  if (array.cross_baseline_m()) return {"+X", "+Y", "-X", "-Y"};
  PerSensor<std::string> out(0);
  for (const Eigen::Vector3d& r_m : array.positions_P_m())
    out.push_back(fmt::format("{:.6g}, {:.6g}, {:.6g} m", r_m.x(), r_m.y(), r_m.z()));
  return out;
}

}  // namespace

WiringProbe::WiringProbe(Instant begin, double speed_up, const calib::sensor::Geometry& array)
    : places_(names_of_places(array)),
      arms_(array.cross_baseline_m().has_value()),
      answer_s_(kAnswer_s * speed_up),
      entered_(begin),
      found_(array.sensors()),
      at_rest_(array.sensors(), Eigen::Vector3d::Zero()),
      sum_(array.sensors(), Eigen::Vector3d::Zero()) {}

void WiringProbe::enter(Phase phase, Instant now) {
  phase_ = phase;
  entered_ = now;
  since_.reset();
  doubtful_ = false;
  first_.reset();
  if (phase == Phase::waiting) ++asked_;
}

void WiringProbe::add(const Epoch& epoch) {
  if (ended()) return;
  switch (phase_) {
    case Phase::resting:
      return rest(epoch);
    case Phase::waiting:
      return wait(epoch);
    case Phase::leaving:
      return leave(epoch);
  }
}

/// The mean of kRest_s in which no sensor went further than a third of what counts as moved.
void WiringProbe::rest(const Epoch& epoch) {
  bool still = first_.has_value();
  for (std::size_t i = 0; still && i < epoch.y_nT.size(); ++i)
    still = (epoch.y_nT[i] - first_->y_nT[i]).norm() < kMoved_nT / 3;
  if (!still) {
    first_ = epoch;
    for (Eigen::Vector3d& sum : sum_) sum.setZero();
    count_ = 0;
  }
  for (std::size_t i = 0; i < sum_.size(); ++i) sum_[i] += epoch.y_nT[i] - first_->y_nT[i];
  ++count_;
  if (epoch.t.mono - first_->t.mono < from_seconds(kRest_s)) return;
  for (std::size_t i = 0; i < sum_.size(); ++i) at_rest_[i] = first_->y_nT[i] + sum_[i] / count_;
  enter(Phase::waiting, epoch.t.mono);
}

WiringProbe::Change WiringProbe::change(const Epoch& epoch) const {
  Change out;
  for (std::size_t i = 0; i < at_rest_.size(); ++i) {
    const double moved_nT = (epoch.y_nT[i] - at_rest_[i]).norm();
    if (moved_nT > out.most_nT) {
      out.second_nT = out.most_nT;
      out.most_nT = moved_nT;
      out.sensor = i;
    } else if (moved_nT > out.second_nT) {
      out.second_nT = moved_nT;
    }
  }
  return out;
}

void WiringProbe::wait(const Epoch& epoch) {
  const Change seen = change(epoch);
  const bool moved = seen.most_nT >= kMoved_nT, clear = seen.most_nT >= kRatio * seen.second_nT;
  doubtful_ = moved && !clear;
  if (!moved || !clear) return since_.reset();
  if (!since_ || moving_ != seen.sensor) since_ = epoch.t.mono;
  moving_ = seen.sensor;
  if (epoch.t.mono - *since_ < from_seconds(kHeld_s)) return;
  found_.at(arm_) = seen.sensor;
  if (arm_ + 1 == places_.size())
    ended_ = MagnetEnd::done;
  else
    enter(Phase::leaving, epoch.t.mono);
}

/// Back at rest; a new rest is learnt, since what was near a magnet may stay magnetised.
void WiringProbe::leave(const Epoch& epoch) {
  if (change(epoch).most_nT >= kMoved_nT / 3) return;
  ++arm_;
  enter(Phase::resting, epoch.t.mono);
}

void WiringProbe::advance(Instant now) {
  if (!ended() && now - entered_ > from_seconds(answer_s_)) ended_ = MagnetEnd::timed_out;
}

void WiringProbe::stop() {
  if (!ended()) ended_ = MagnetEnd::stopped;
}

std::string WiringProbe::prompt() const {
  const std::string where = fmt::format("{} {} ({})", arms_ ? "arm" : "place", arm_ + 1, places_.at(arm_));
  switch (phase_) {
    case Phase::resting:
      return fmt::format("keep the magnet away and the array still; next is {}", where);
    case Phase::leaving:
      return fmt::format("{} {} is seen; take the magnet away", arms_ ? "arm" : "place", arm_ + 1);
    case Phase::waiting:
      break;
  }
  const std::string ask = fmt::format("hold the magnet to {}{}", arms_ ? "the end of " : "", where);
  if (!doubtful_) return ask;
  return fmt::format("{}: more than one sensor moves; nearer to the {}, and away from the others", ask,
                     arms_ ? "end" : "sensor there");
}

MagnetStatus WiringProbe::status() const {
  static constexpr std::array<const char*, 3> kPhases{"resting", "waiting", "leaving"};
  MagnetStatus out;
  out.end = ended_;
  out.noun = arms_ ? "arm" : "place";
  out.sensor_on_arm.resize(places_.size());
  out.asked = asked_;
  for (std::size_t arm = 0; arm < found_.size(); ++arm) {
    if (found_.at(arm)) out.sensor_on_arm.at(arm) = static_cast<int>(*found_.at(arm)) + 1;
  }
  if (!ended_) {
    out.state = kPhases.at(static_cast<std::size_t>(phase_));
    out.arm = static_cast<int>(arm_) + 1;
    out.text = prompt();
  } else if (*ended_ == MagnetEnd::done) {
    out.state = "done";
    const auto right = all_right(out);
    out.text = !right   ? fmt::format("one sensor answered for two {}s", out.noun)
               : *right ? fmt::format("every cable is {} its {}", arms_ ? "on" : "at", out.noun)
                        : fmt::format("cables are {} other {}s than their labels say", arms_ ? "on" : "at",
                                      out.noun);
  } else if (*ended_ == MagnetEnd::timed_out) {
    out.state = "timed out";
    out.text = fmt::format("nothing clear was seen for {} {} within {:.0f} s: it stays open", out.noun,
                           arm_ + 1, kAnswer_s);
  } else {
    out.state = "stopped";
    out.text = fmt::format("stopped before {} {} was seen", out.noun, arm_ + 1);
  }
  if (ended_) out.text += "; put the magnet away";
  return out;
}

Result<void> ready_for_magnet(const std::vector<std::pair<Slot, LinkHealth>>& links) {
  std::size_t sensors = 0;
  std::string dumb;
  for (const auto& [slot, health] : links) {
    sensors += slot.sensor_index() ? std::size_t{1} : 0;
    if (!slot.sensor_index() || health.state == LinkState::live) continue;
    const std::string_view state = kLinkStateNames.at(static_cast<std::size_t>(health.state));
    dumb += fmt::format("{}{} is {}{}", dumb.empty() ? "" : "; ", slot.name(), state,
                        health.detail.empty() ? "" : " (" + health.detail + ")");
  }
  if (sensors == 1)
    return fail(ErrorCode::state, "a magnet test finds exchanged cables, and this rig has one sensor",
                "nothing is to be done: one cable cannot be exchanged");
  if (dumb.empty()) return {};
  return fail(ErrorCode::state,
              fmt::format("a magnet test needs all {} sensors live: {}",
                          sensors == kSensorCount ? "four" : fmt::format("{}", sensors), dumb),
              "check its port, cable and supply; when mgt status shows it live, say it again");
}

}  // namespace mgtd::daemon::run
