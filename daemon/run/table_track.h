// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>

#include "proto/reading.h"
#include "proto/time.h"

/// TableTrack keeps what the table has reported: where it is, how it came there, and since when it rests.
/// Angles in radians.
namespace mgtd::daemon::run {

class TableTrack {
 public:
  static constexpr std::size_t kLongestPath = 500;  ///< readings, before they are to be stored

  /// `recorded`: the attitude that goes into the path; empty: the way is not known.
  void add(const TableReading& reading, const std::optional<TableAngles>& recorded);
  /// Cannot be reached: it may be anywhere.
  void lost();

  [[nodiscard]] const std::optional<TableReading>& latest() const { return latest_; }
  /// The latest report is of after `since`.
  [[nodiscard]] bool reported_after(Instant since) const { return latest_ && latest_->arrival.mono > since; }
  /// Since when it rests here: a pose that is measured again does not begin a new rest.
  [[nodiscard]] std::optional<Instant> rests_since() const;

  /// The angles have a reference: the reference move was made, and nothing has taken it away since.
  [[nodiscard]] bool referenced() const { return referenced_; }
  void set_referenced(bool referenced) { referenced_ = referenced; }

  /// Direction of the last azimuth move, +1 or -1; empty: not known.
  [[nodiscard]] std::optional<int> sense() const { return sense_; }
  void set_sense(std::optional<int> sense) { sense_ = sense; }

  [[nodiscard]] bool path_full() const { return path_.size() >= kLongestPath; }
  [[nodiscard]] std::vector<TableReading> take_path();

 private:
  std::optional<TableReading> latest_;
  std::optional<TableReading> rest_;  ///< the first report at rest here, whatever was commanded since
  std::vector<TableReading> path_;    ///< changes that are not stored yet
  std::optional<int> sense_;
  bool referenced_{false};
};

/// The largest difference of the three angles.
[[nodiscard]] double furthest_rad(const TableAngles& a, const TableAngles& b);

}  // namespace mgtd::daemon::run
