// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "calib/criticism/search/explain.h"
#include "calib/criticism/search/model_stage.h"

/// improve() repeats explain, add and fit, unattended, until nothing more is justified. Calibrated p-values
/// decide what is added; the error on held-out poses is a veto, never a reason. A round after which it rises
/// is kept only where a later one lowers it again.
namespace mgtd::calib::criticism::search {

struct ImproveRound {
  tests::Candidate added;
  std::vector<std::string> possible{};       ///< others that could stand in its place
  double rms_before_nT{0}, rms_after_nT{0};  ///< residual, as PoseResiduals tells it
  std::optional<double> held_out_before_nT{}, held_out_after_nT{};
  double predicted_fall{0}, realised_fall{0};  ///< of chi-square
  VariancePrice price{};                       ///< what the parameters of the sensors lose
};

/// Why no more was added.
enum class ImproveStop {
  nothing_stands_out,
  no_effect_looks_like_it,
  bad_data,
  round_limit,           ///< kImproveRounds
  nothing_can_be_added,  ///< something stands out, and no fit with what stands for it succeeds
  held_out_error_rises,  ///< on poses that the fit has not seen: ImproveReport::refused
};

/// Rounds after which improve() stops: twice the effects that any simulated instrument has had.
inline constexpr std::size_t kImproveRounds = 24;

/// An effect that was not added, because the error on poses left out rises with it.
struct RefusedEffect {
  std::string spec{};
  double held_out_before_nT{0}, held_out_after_nT{0};
};

struct ImproveReport {
  std::vector<ImproveRound> rounds{};
  Finding finding{Finding::pass};  ///< of what is left at the end
  ImproveStop stopped{ImproveStop::nothing_stands_out};
  std::optional<RefusedEffect> refused{};  ///< with ImproveStop::held_out_error_rises
  std::vector<ExplainNote> notes{};        ///< of explain()
  fit::FitReport fit;                      ///< with everything that was added
};

/// `also`: candidates beside those of the library.
[[nodiscard]] Result<ImproveReport> improve(const PoseTable& table, const fit::FitOptions& options,
                                            const std::vector<tests::CandidateEffect>& also = {});

}  // namespace mgtd::calib::criticism::search
