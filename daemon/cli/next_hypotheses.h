// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "calib/criticism/search/choice.h"
#include "calib/design/hypothesis.h"
#include "calib/fit/method_choice/fit.h"
#include "daemon/store/pose_source.h"

/// These functions gather the hypotheses that `mgt next` tells apart where a formula is among them, and the
/// model without any of them.
namespace mgtd::daemon::cli {

struct Question {
  calib::fit::FitOptions options;                     ///< the model without the hypotheses
  std::vector<calib::design::Hypothesis> hypotheses;  ///< none: nothing of this kind to ask
};

/// Effects of the library by name alone: what explain() compares wherever they act.
[[nodiscard]] bool names_of_the_library(const std::vector<std::string>& named,
                                        const store::PoseSource& source);

/// Formulas and effects as `mgt define` and --with write them. A name without a place takes that of the
/// others.
[[nodiscard]] Result<Question> question_of(const std::vector<std::string>& named,
                                           const store::PoseSource& source,
                                           const calib::fit::FitOptions& options);

/// A formula of the model that was chosen in doubt, or an effect with a formula among its alternatives.
[[nodiscard]] Result<Question> question_in_doubt(const std::vector<calib::criticism::search::Choice>& doubts,
                                                 const store::PoseSource& source,
                                                 const calib::fit::FitOptions& options);

/// The formulas that `mgt discover` leaves: of the strongest law, at `place` if it is not empty, that has
/// several.
[[nodiscard]] Result<Question> question_by_discovery(const std::string& place,
                                                     const store::PoseSource& source,
                                                     const calib::fit::FitOptions& options);

}  // namespace mgtd::daemon::cli
