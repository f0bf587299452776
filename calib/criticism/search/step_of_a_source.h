// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/criticism/search/model_stage.h"

namespace mgtd::calib::criticism::search {

/// step_of_a_source() looks for the source behind a step of the site: the dipole, and the moment at which it
/// came, that take away most of what a model without the step leaves (tests/dipole_search.h). A magnet that
/// was put down beside the array is no gradient.
///
/// `before`: the model without the step, which is the last effect of `with`. Gives the stage with the dipole
/// in its place where the dipole leaves clearly less; empty where it does not, or where that effect is no
/// step of the site or has a place already.
[[nodiscard]] std::optional<ModelStage> step_of_a_source(const PoseTable& table,
                                                         const fit::FitOptions& options,
                                                         const ModelStage& before, const ModelStage& with);

}  // namespace mgtd::calib::criticism::search
