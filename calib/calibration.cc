// SPDX-License-Identifier: Apache-2.0
#include "calib/calibration.h"

#include "calib/calibration_json.h"

namespace mgtd::calib {

void Calibration::seal() { id = content_id(to_json(*this)); }

}  // namespace mgtd::calib
