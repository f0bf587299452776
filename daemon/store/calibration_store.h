// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calib/calibration/calibration.h"
#include "proto/error.h"
#include "proto/time.h"

/// The store keeps calibrations on disk as immutable `<id>.json` files, with one append-only log of what
/// became of them. The active calibration is what the log says; a calibration is never changed or deleted.
/// Every step is written, synced and renamed: killed at any moment, the store holds either the state before
/// or the state after.
namespace mgtd::daemon::store {

enum class CalibrationState { proposed, accepted, active, rejected };
[[nodiscard]] std::string_view name(CalibrationState state);

struct CalibrationEntry {
  std::string id;
  CalibrationState state{CalibrationState::proposed};
  WallTime since;      ///< when it entered that state
  std::string origin;  ///< run id, or file it was imported from
  bool forced{false};  ///< it failed its checks and was made active all the same
  std::string why{};   ///< the reason given when it was rejected or last accepted; may be empty
  std::string by{};    ///< who decided that; empty: an earlier version did not keep it
};

/// Somebody, or the program by itself, proposed a calibration, accepted or rejected it, or returned to it.
struct CalibrationDecision {
  WallTime at;
  std::string what;  ///< "proposed", "accepted", "rejected", "rolled-back": the one returned to
  std::string id;
  std::string origin{};  ///< of a proposal: run id, or file it was imported from
  bool forced{false};
  std::string why{};  ///< the reason given; may be empty
  std::string by{};   ///< user, console, or kAutomatic; empty: an earlier version did not keep it
};
/// Decided by the program, as when a run proposes what it found.
inline constexpr std::string_view kAutomatic = "automatic";

class CalibrationStore {
 public:
  /// Creates the directory when it is missing; reads the log. A torn last line (power cut) is dropped; a log
  /// or file that is damaged otherwise is refused by name.
  [[nodiscard]] static Result<CalibrationStore> open(std::filesystem::path directory);

  /// Proposing what is already known changes nothing. Refuses an unsealed calibration. `by`, here and below:
  /// who decides.
  [[nodiscard]] Result<void> propose(const calib::calibration::Calibration& calibration,
                                     std::string_view origin, WallTime now, std::string_view by = kAutomatic);
  /// Proposes a calibration that was made elsewhere. Refuses one that cannot be used (calibration_validity.h)
  /// and, without `force`, one that failed its checks. Does not know the rig: whether it is of this array is
  /// the caller's question.
  [[nodiscard]] Result<void> import(const calib::calibration::Calibration& calibration,
                                    std::string_view origin, bool force, WallTime now,
                                    std::string_view by = {});
  /// Makes a proposed (or formerly active) calibration active. Refuses an unknown id and, without `force`,
  /// one that failed its checks or was rejected.
  [[nodiscard]] Result<void> accept(std::string_view id, WallTime now, bool force = false,
                                    std::string_view why = {}, std::string_view by = {});
  /// Takes a proposed calibration off the proposals; its file stays. Refuses an unknown id, and one that is
  /// or was in use.
  [[nodiscard]] Result<void> reject(std::string_view id, std::string_view why, WallTime now,
                                    std::string_view by = {});
  /// Back to the calibration that was active before this one. Gives its id.
  [[nodiscard]] Result<std::string> rollback(WallTime now, std::string_view by = {});

  [[nodiscard]] std::optional<std::string> active_id() const;
  /// Empty when none is active.
  [[nodiscard]] Result<std::optional<calib::calibration::Calibration>> active() const;
  [[nodiscard]] std::vector<CalibrationEntry> list() const { return entries_; }
  /// All of them, in the order in which they were made.
  [[nodiscard]] const std::vector<CalibrationDecision>& decisions() const { return decisions_; }
  [[nodiscard]] Result<calib::calibration::Calibration> show(std::string_view id) const;

 private:
  explicit CalibrationStore(std::filesystem::path directory) : directory_(std::move(directory)) {}
  [[nodiscard]] Result<void> read_log();
  [[nodiscard]] Result<void> record(const CalibrationDecision& decision);
  void apply(const CalibrationDecision& decision);
  [[nodiscard]] CalibrationEntry* find(std::string_view id);
  [[nodiscard]] std::filesystem::path file_of(std::string_view id) const;

  std::filesystem::path directory_;
  std::vector<CalibrationEntry> entries_;
  std::vector<CalibrationDecision> decisions_;
  std::vector<std::string> activations_;  ///< stack: last is active
};

}  // namespace mgtd::daemon::store
