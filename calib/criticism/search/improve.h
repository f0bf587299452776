// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "calib/criticism/search/explain.h"
#include "calib/criticism/search/model_stage.h"

/// explain -> add -> fit, round by round and unattended, until nothing more is justified. What is added is
/// decided by calibrated p-values; the error on poses that were left out is a veto, never a reason.
namespace mgtd::calib {

struct ImproveRound {
  Candidate added;
  std::vector<std::string> possible{};       ///< others that could stand in its place
  double rms_before_nT{0}, rms_after_nT{0};  ///< residual, as PoseResiduals tells it
  std::optional<double> held_out_before_nT{}, held_out_after_nT{};
  double predicted_fall{0}, realised_fall{0};  ///< of chi-square
  VariancePrice price{};                       ///< what the parameters of the sensors lose
};

struct ImproveReport {
  std::vector<ImproveRound> rounds{};
  Finding finding{Finding::pass};  ///< of what is left at the end
  std::string stopped{};           ///< why no more was added
  std::vector<std::string> notes{};
  FitReport fit;  ///< with everything that was added
};

[[nodiscard]] Result<ImproveReport> improve(const PoseTable& table, const FitOptions& options);

}  // namespace mgtd::calib
