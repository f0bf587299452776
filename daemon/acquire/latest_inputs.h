// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "proto/input_value.h"
#include "proto/reading.h"

/// LatestInputs keeps the last reading of every auxiliary input and of every sensor's thermometer, by column.
/// A reading that is older than kFreshInput says nothing of now.
namespace mgtd::daemon::acquire {

inline constexpr auto kFreshInput = std::chrono::seconds(120);  ///< twice the slowest asking

class LatestInputs {
 public:
  /// `columns`: those of the configuration, in the order in which they are shown.
  explicit LatestInputs(std::vector<std::string> columns = {});

  void push(const AuxiliaryReading& reading);
  void push(const TemperatureReading& reading);
  /// To be called with the time before the values are looked at.
  void advance(Instant now);

  /// All columns of the configuration.
  [[nodiscard]] std::span<const InputValue> values() const { return values_; }
  /// The fresh ones of all that were heard but the thermometers.
  [[nodiscard]] const std::map<std::string, double>& covariates() const { return covariates_; }
  /// When it was heard last.
  [[nodiscard]] std::optional<Instant> heard(std::string_view column) const;

 private:
  void set(const std::string& column, double value, Instant at);

  std::vector<InputValue> values_;
  std::map<std::string, double> covariates_;
  std::map<std::string, Instant, std::less<>> heard_;
};

}  // namespace mgtd::daemon::acquire
