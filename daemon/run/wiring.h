// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "proto/pose.h"
#include "proto/units.h"

/// Wiring finds sensors that are mounted or wired another way than the others, from raw readings in a few
/// attitudes: which of the 48 signed permutations S makes y = S y_reference, and R(table)' S' y the same
/// field in every attitude? The reference is the sensor that most others agree with.
///
/// Sensors that are not calibrated yet differ by some percent of the field, so a permutation is told from
/// another where it changes the reading by more than kTolerance of it. What one attitude leaves open, the
/// first turns of the table close; until then nothing is claimed. One sensor is compared with the table
/// alone. Swapped cables are not seen here (wiring_probe.h).
namespace mgtd::daemon::run {

class Wiring {
 public:
  static constexpr double kTolerance = 0.1;  ///< of the field, rms
  static constexpr double kForeign = 0.3;    ///< further off in every way: no matter of mounting

  /// Raw readings in one attitude; the table's angles where they are known.
  void add(const PerSensor<Eigen::Vector3d>& y_nT, const std::optional<TableAngles>& angles);
  [[nodiscard]] std::size_t attitudes() const { return seen_.size(); }

  /// One sentence each: "s3: mirrored (left-handed axes: y reversed)". Empty: all alike, and as the
  /// table turns.
  [[nodiscard]] std::vector<std::string> findings() const;

 private:
  struct Seen {
    PerSensor<Eigen::Vector3d> y;  ///< in units of the field
    std::optional<Eigen::Matrix3d> R_PS;
  };
  using Ways = std::vector<Eigen::Matrix3d>;
  [[nodiscard]] Ways against(std::size_t slot, std::size_t reference) const;
  [[nodiscard]] std::optional<Ways> against_table(std::size_t reference) const;
  [[nodiscard]] std::size_t reference() const;

  std::vector<Seen> seen_;
};

/// What is said where nothing was found: "all four alike"; one sensor has no other to be like.
[[nodiscard]] std::string alike_in_words(std::size_t sensors);

/// y = S b as words: "turned by 90 deg about z", "mirrored (left-handed axes: y reversed)".
[[nodiscard]] std::string in_words(const Eigen::Matrix3d& S);

}  // namespace mgtd::daemon::run
