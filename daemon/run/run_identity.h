// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "daemon/acquire/instrument_watch.h"
#include "daemon/run/run_events.h"
#include "proto/check.h"
#include "proto/instrument_identity.h"

/// RunIdentity tells whether a run is measured with the sensors that the active calibration was made with,
/// and with those that it began with. It goes by what the devices tell of themselves, and by what the stream
/// concludes from their readings.
///
/// A sensor that is not the calibrated one fails the check `identity` of the first preflight; the operator
/// may mean it so and resume. One that is not the one that this run began with fails it for as long as it is
/// there.
namespace mgtd::daemon::run {

class RunIdentity {
 public:
  /// Of the active calibration, and of an earlier life of this run; empty: not known.
  RunIdentity(const std::vector<InstrumentIdentity>& calibrated, const std::vector<InstrumentIdentity>& own);

  /// `who` answers in its place. True: what is said of the sensors of this run has changed.
  bool answers(const InstrumentIdentity& who);
  /// Another one answers than this run began with; empty: none does.
  [[nodiscard]] std::string exchanged() const { return own_.measured(); }
  [[nodiscard]] std::string remedy() const { return own_.remedy(); }

  /// What the readings say. True: it is new, and nobody has confirmed it.
  bool readings_say(const ReadingsSay& say);
  /// It is looked at by the preflight.
  void remember(const ReadingsSay& say) { readings_say_ = say; }

  [[nodiscard]] Check check() const;
  /// An operator who resumes after this means it so.
  void ask_once(const Check& failed);
  [[nodiscard]] const std::string& confirmed() const { return confirmed_; }
  /// From now on these are the sensors of this run. Empty: they were known already.
  [[nodiscard]] std::vector<InstrumentIdentity> begin();

 private:
  acquire::InstrumentWatch own_{acquire::kByRun}, calibrated_{acquire::kByCalibration};
  std::vector<InstrumentIdentity> answering_;  ///< by place
  ReadingsSay readings_say_;
  std::string confirmed_;  ///< what was said of another sensor before the operator resumed
};

}  // namespace mgtd::daemon::run
