// SPDX-License-Identifier: Apache-2.0
#include "calib/calibration.h"

#include "calib/calibration_json.h"
#include "proto/sha256.h"

namespace mgtd::calib {

void Calibration::seal() {
  nlohmann::json content = to_json(*this);
  content.erase("id");
  id = "c" + sha256_hex(content.dump()).substr(0, 12);
}

}  // namespace mgtd::calib
