// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "calib/design/experiment_design.h"
#include "daemon/plan/run_plan.h"
#include "drivers/device.h"
#include "proto/error.h"

/// LimitsCost says how much accuracy the limits of a table cost a run: it holds the expected standard errors
/// of the run within the limits (calib/design/experiment_design.h) beside those of the same run, with as many
/// poses, on the same axes without limits: azimuth and roll a whole turn, pitch from -90 to 90 deg. An axis
/// that the table does not have is no limit.
namespace mgtd::daemon::run {

struct LimitsCost {
  /// An axis that does not reach everything.
  struct Axis {
    std::string name;  ///< "roll"
    double min_deg{0}, max_deg{0};
  };
  /// Root mean squares of standard errors: of the tensor's components, of parameters of one kind.
  struct Group {
    std::string name;  ///< "tensor", "angles to the platform"
    std::string unit;
    double within{0}, without{0};  ///< infinite: not determined
    std::string worst;             ///< the one whose error grows most
    double worst_times{1};
    [[nodiscard]] double times() const { return within / without; }
  };
  std::vector<Axis> axes;
  double left_out{0};         ///< share of all attitudes
  std::vector<Group> groups;  ///< the tensor first, where the array tells any of it
  int random{0};              ///< poses of the random set
  /// So many random poses within the limits would make up for them; empty: four times as many would not.
  std::optional<int> random_enough;
};

/// Share of all attitudes (Haar measure) that a table with these axes reaches without limits and not within.
[[nodiscard]] double attitudes_left_out(const drivers::TableLimits& limits);

/// `request` but for its poses. Nothing where the limits leave nothing out.
[[nodiscard]] Result<std::optional<LimitsCost>> limits_cost(const plan::PlanOptions& options,
                                                            const drivers::TableLimits& limits,
                                                            calib::design::DesignRequest request);

[[nodiscard]] nlohmann::json to_json(const LimitsCost& cost);
/// A table with what to do.
[[nodiscard]] std::string to_text(const LimitsCost& cost);

}  // namespace mgtd::daemon::run
