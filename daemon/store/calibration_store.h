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
};

class CalibrationStore {
 public:
  /// Creates the directory when it is missing; reads the log. A torn last line (power cut) is dropped; a log
  /// or file that is damaged otherwise is refused by name.
  [[nodiscard]] static Result<CalibrationStore> open(std::filesystem::path directory);

  /// Proposing what is already known changes nothing. Refuses an unsealed calibration.
  [[nodiscard]] Result<void> propose(const calib::calibration::Calibration& calibration,
                                     std::string_view origin, WallTime now);
  /// Proposes a calibration that was made elsewhere. Refuses one that cannot be used (calibration_validity.h)
  /// and, without `force`, one that failed its checks. Does not know the rig: whether it is of this array is
  /// the caller's question.
  [[nodiscard]] Result<void> import(const calib::calibration::Calibration& calibration,
                                    std::string_view origin, bool force, WallTime now);
  /// Makes a proposed (or formerly active) calibration active. Refuses an unknown id and, without `force`,
  /// one that failed its checks or was rejected.
  [[nodiscard]] Result<void> accept(std::string_view id, WallTime now, bool force = false,
                                    std::string_view why = {});
  /// Takes a proposed calibration off the proposals; its file stays. Refuses an unknown id, and one that is
  /// or was in use.
  [[nodiscard]] Result<void> reject(std::string_view id, std::string_view why, WallTime now);
  /// Back to the calibration that was active before this one. Gives its id.
  [[nodiscard]] Result<std::string> rollback(WallTime now);

  [[nodiscard]] std::optional<std::string> active_id() const;
  /// Empty when none is active.
  [[nodiscard]] Result<std::optional<calib::calibration::Calibration>> active() const;
  [[nodiscard]] std::vector<CalibrationEntry> list() const { return entries_; }
  [[nodiscard]] Result<calib::calibration::Calibration> show(std::string_view id) const;

 private:
  struct Event {
    WallTime at;
    std::string what, id, origin;
    bool forced{false};
    std::string why{};
  };
  explicit CalibrationStore(std::filesystem::path directory) : directory_(std::move(directory)) {}
  [[nodiscard]] Result<void> read_log();
  [[nodiscard]] Result<void> record(const Event& event);
  void apply(const Event& event);
  [[nodiscard]] CalibrationEntry* find(std::string_view id);
  [[nodiscard]] std::filesystem::path file_of(std::string_view id) const;

  std::filesystem::path directory_;
  std::vector<CalibrationEntry> entries_;
  std::vector<std::string> activations_;  ///< stack: last is active
};

}  // namespace mgtd::daemon::store
