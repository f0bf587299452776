// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "calib/fit/dwell_motion.h"
#include "calib/fit/joint/reference_scatter.h"

/// These functions say in words how well a reference agrees with what it is compared with, and how the field
/// moved.
namespace mgtd::calib::report {

/// Measured and stated standard deviation.
[[nodiscard]] std::string reference_scatter_text(const fit::joint::ReferenceScatter& scatter);

/// What to do where the two are far apart; empty where they are not.
[[nodiscard]] std::string reference_scatter_remark(const fit::joint::ReferenceScatter& scatter);

/// That the spread within the dwells contains what the field did meanwhile; empty where that is less than a
/// third of the noise of a sample.
[[nodiscard]] std::string dwell_motion_text(const fit::DwellMotion& motion, double sample_noise_nT);

}  // namespace mgtd::calib::report
