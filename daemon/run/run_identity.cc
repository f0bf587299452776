// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/run_identity.h"

#include <algorithm>

namespace mgtd::daemon::run {

RunIdentity::RunIdentity(const std::vector<InstrumentIdentity>& calibrated,
                         const std::vector<InstrumentIdentity>& own) {
  calibrated_.want(calibrated);
  own_.want(own);
}

bool RunIdentity::answers(const InstrumentIdentity& who) {
  if (who.identity.empty()) return false;
  const auto known = std::find_if(answering_.begin(), answering_.end(),
                                  [&](const InstrumentIdentity& i) { return i.place == who.place; });
  if (known != answering_.end() && *known == who) return false;
  if (known == answering_.end())
    answering_.push_back(who);
  else
    *known = who;
  const std::string before = own_.measured();
  own_.answers(who);
  calibrated_.answers(who);
  return own_.measured() != before;
}

bool RunIdentity::readings_say(const ReadingsSay& say) {
  remember(say);
  if (say.measured.empty() || say.measured == confirmed_) return false;
  confirmed_ = say.measured;
  return true;
}

Check RunIdentity::check() const {
  const acquire::InstrumentWatch& watch = own_.another() ? own_ : calibrated_;
  const std::string measured = watch.another() ? watch.measured() : readings_say_.measured;
  const std::string remedy = watch.another() ? watch.remedy() : readings_say_.remedy;
  if (measured.empty()) return {"identity", true, "no sensor is known to be another one", "none", ""};
  return {"identity", !own_.another() && measured == confirmed_, measured,
          "the sensors of the active calibration, each in its place", remedy};
}

void RunIdentity::ask_once(const Check& failed) {
  if (!own_.another()) confirmed_ = failed.measured;
}

std::vector<InstrumentIdentity> RunIdentity::begin() {
  if (own_.wants()) return {};
  std::sort(answering_.begin(), answering_.end(),
            [](const InstrumentIdentity& a, const InstrumentIdentity& b) { return a.place < b.place; });
  own_.want(answering_);
  return answering_;
}

}  // namespace mgtd::daemon::run
