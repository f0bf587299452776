// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "tests/accuracy/campaign.h"

/// This counts how often the commands that answer yes or no are wrong.
namespace mgtd::testing {

struct Alarms {
  int runs{0};
  int false_check{0};  ///< a dozen poses of an unchanged rig called changed
  int false_diff{0};   ///< two runs of an unchanged rig called different
  int seen_check{0};   ///< an offset changed by the size that is said to be seen in 80 of 100 cases
  double size_nT{0};   ///< that size, mean over the runs
  int named_check{0};  ///< and the parameter named rightly
};

[[nodiscard]] Alarms alarms(const Scene& scene, int runs);

/// Real errors of many runs at the same attitudes over those that `mgt plan` foretold.
struct Foretold {
  int runs{0};
  double rms_ratio{0};           ///< over all parameters
  double lowest{0}, highest{0};  ///< of a single parameter
  double expected_spread{0};     ///< one standard deviation of a single ratio
};
[[nodiscard]] Foretold foretold(const Scene& scene, int runs);

}  // namespace mgtd::testing
