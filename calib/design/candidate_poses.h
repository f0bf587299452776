// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "calib/design/law_actions.h"

/// candidate_poses() lists the poses that an action could consist of.
///
/// They follow each other as those of the run did. The temperatures go on as they went, and so does a column
/// that goes with the time (a battery); other columns take values that they had. On another day the course
/// of the run begins anew. What the action changes comes on top of that.
namespace mgtd::calib::design {

struct CandidatePose {
  Pose pose;  ///< readings stand for the field and the attitude only, as the sensors would make them
  double minutes{0};
};

/// Poses that could be the k-th of an action: `count` of them for each k where the action is placed and the
/// run turnable; else the run's own attitude. Attitudes are spread over the rotations within the angles of
/// the run, approach and waits over what it recorded. Fixed by `seed`.
[[nodiscard]] std::vector<std::vector<CandidatePose>> candidate_poses(
    const PoseTable& run, const LawAction& action, const PerSensor<sensor::SensorModel>& sensors,
    std::size_t count, std::uint64_t seed);

}  // namespace mgtd::calib::design
