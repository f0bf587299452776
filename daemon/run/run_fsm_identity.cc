// SPDX-License-Identifier: Apache-2.0
// Who measures: the sensors of the active calibration, and those that the run began with.
#include <fmt/format.h>

#include <algorithm>

#include "daemon/acquire/calibrated_with.h"
#include "daemon/run/run_fsm.h"

namespace mgtd::daemon {

void RunFsm::look_at_identity(const InstrumentIdentity& who) {
  if (who.told.empty()) return;
  const auto known = std::find_if(answering_.begin(), answering_.end(),
                                  [&](const InstrumentIdentity& i) { return i.place == who.place; });
  if (known != answering_.end() && *known == who) return;
  if (known == answering_.end())
    answering_.push_back(who);
  else
    *known = who;
  const std::string before = own_.measured();
  own_.answers(who);
  calibrated_.answers(who);
  const std::string now = own_.measured();
  if (now == before || phase_ == Phase::preflight) return;
  if (now.empty()) {
    act(Record{"every sensor is again the one that this run began with"});
    if (phase_ == Phase::paused) message_ = "every sensor answers in its place again; mgt run resume goes on";
  } else if (measuring()) {
    hold(now + "; " + own_.remedy());
  } else if (phase_ == Phase::paused) {
    message_ = now + "; " + own_.remedy();
  }
  changed_ = true;
}

void RunFsm::on(const ReadingsSay& say) {
  readings_say_ = say;
  if (say.measured.empty() || phase_ == Phase::preflight || !measuring() || say.measured == confirmed_)
    return;
  confirmed_ = say.measured;
  hold(say.measured + "; " + say.remedy + "; when it is meant so: mgt run resume");
}

Check RunFsm::identity_check() const {
  const InstrumentWatch& watch = own_.another() ? own_ : calibrated_;
  const std::string measured = watch.another() ? watch.measured() : readings_say_.measured;
  const std::string remedy = watch.another() ? watch.remedy() : readings_say_.remedy;
  if (measured.empty()) return {"identity", true, "no sensor is known to be another one", "none", ""};
  return {"identity", !own_.another() && measured == confirmed_, measured,
          "the sensors of the active calibration, each in its place", remedy};
}

bool RunFsm::identity_settled() {
  const Check& check = checks_.back();
  if (!check.passed) {
    preflight_passed_ = false;
    if (!own_.another()) confirmed_ = check.measured;
    hold(check.measured + "; " + check.remedy +
         (own_.another() ? "" : "; when it is meant so, mgt run resume measures as it is"));
    return false;
  }
  if (!confirmed_.empty()) act(Record{"the operator goes on although " + confirmed_});
  if (own_.wants()) return true;
  std::sort(answering_.begin(), answering_.end(),
            [](const InstrumentIdentity& a, const InstrumentIdentity& b) { return a.place < b.place; });
  own_.want(answering_);
  if (!answering_.empty()) act(StoreChecks{kInstrumentsStage, to_checks(answering_)});
  return true;
}

}  // namespace mgtd::daemon
