// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calib/calibration/calibration.h"
#include "daemon/acquire/live_pipeline.h"
#include "daemon/config/config.h"
#include "proto/journal_note.h"
#include "proto/raw_log.h"
#include "proto/tensor_encoder.h"

/// A Replay makes the stream again from a journal of raw bytes: the drivers, the sampler and the tensor of
/// the daemon get the same bytes, ticks and orders at the same times and say the same, TENSOR and GAP lines
/// to the last byte. Pure: the time is the journal's. It needs the journal from its first record on.
///
/// Whether it went as it did then is checked as well: what the drivers want to send must be what was sent.
namespace mgtd::daemon::acquire {

struct ReplayCounts {
  std::uint64_t lives{0}, records{0}, samples{0}, missing{0}, gaps{0};
  std::uint64_t bytes_lost{0};        ///< not in the journal because the disk refused
  std::optional<std::string> parted;  ///< where drivers and journal first disagree
};

class Replay {
 public:
  /// `line`: a line of the stream without its end. `instead`: this calibration all along, not those used
  /// then.
  Replay(std::function<void(std::string_view)> line,
         std::shared_ptr<const calib::calibration::Calibration> instead);
  ~Replay();

  /// Refuses what cannot be replayed, and a calibration of another array than the one that was recorded.
  [[nodiscard]] Result<void> feed(const RawRecord& record);
  [[nodiscard]] const ReplayCounts& counts() const { return counts_; }

 private:
  struct Life;

  [[nodiscard]] Result<void> note(const RawRecord& record);
  [[nodiscard]] Result<void> on(const LifeNote& life);
  [[nodiscard]] Result<void> on(const CalibrationNote& calibration);
  [[nodiscard]] Result<void> on(const CalibratingNote& calibrating);
  [[nodiscard]] Result<void> on(const ReopenedNote& reopened);
  [[nodiscard]] Result<void> on(const TableOrder& order);
  [[nodiscard]] Result<void> on(const TableNote& table);
  [[nodiscard]] Result<void> on(const LostNote& lost);
  [[nodiscard]] Result<void> use(std::shared_ptr<const calib::calibration::Calibration> calibration);
  void tell_device(const RawRecord& record);
  void check_sent(const RawRecord& record);
  void take_events(std::uint8_t number);
  void deliver();
  void say(const Gap& gap);

  std::function<void(std::string_view)> line_;
  std::shared_ptr<const calib::calibration::Calibration> instead_;
  std::unique_ptr<Life> life_;
  TensorEncoder encoder_;
  ReplayCounts counts_;
};

}  // namespace mgtd::daemon::acquire
