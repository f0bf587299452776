// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "calib/criticism/search/explain.h"
#include "tests/blind/real_kind.h"

/// This compares what fit and explain say of one run with the truth.
namespace mgtd::calib::testing {

struct RealAnswer {
  bool fit_refused{false}, explain_refused{false};
  bool accepted{false};  ///< by the checks of the fit
  criticism::search::Finding finding{criticism::search::Finding::pass};
  bool left_out{false};  ///< explain set something aside
  std::vector<std::string> named{};
  std::vector<std::string> declared{};  ///< named, or possible in the place of a name
  /// Of the tensor of a uniform field that turns over all attitudes, rms over the six components, nT/m: the
  /// calibration of the fit; that of explain's last model; and that of the same run of a plain rig.
  std::optional<double> error_nT_per_m{}, error_after_nT_per_m{}, plain_nT_per_m{};
  /// Normalised errors squared by the covariance of the fit: of the 36 scales and angles, and of the 12
  /// offsets.
  std::optional<double> nees_scales{}, nees_offsets{};
  double cpu_s{0};  ///< fit and explain; the only number that is another on another machine

  [[nodiscard]] bool named_any() const { return !named.empty(); }
  /// EXPLAINED by one name that is not right.
  [[nodiscard]] bool wrong_single(const RealKind& kind) const;
  /// Named, and not right.
  [[nodiscard]] bool wrong_name(const RealKind& kind) const;
  [[nodiscard]] double over_plain() const { return *error_after_nT_per_m / *plain_nT_per_m; }
  /// What must be said was said, and where nothing is to be modelled the calibration is as good as that of
  /// the plain rig to 1.2.
  [[nodiscard]] bool good(const RealKind& kind) const;
};

/// As a line of an answer file.
void to_json(nlohmann::json& j, const RealAnswer& answer);
void from_json(const nlohmann::json& j, RealAnswer& answer);

[[nodiscard]] RealAnswer answer_to(const RealRun& run, bool parameters);
/// "PARTIAL axis.gain.step axis.transverse, 0.05 nT/m (plain 0.03)".
[[nodiscard]] std::string told(const RealAnswer& answer);

inline constexpr double kScales = 36, kOffsets = 12;

}  // namespace mgtd::calib::testing
