// SPDX-License-Identifier: Apache-2.0
// Whatever a file holds that is given as CAL.json: a calibration that is accepted is finite and survives
// being written and read again under the same id.
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string_view>

#include "calib/calibration/calibration_json.h"
#include "tests/fuzz/require.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using mgtd::testing::require;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  auto object = nlohmann::json::parse(text, nullptr, false);
  if (object.is_discarded()) return 0;
  // A fuzzer does not guess hashes: the id is set right, so that what is behind it is reached.
  if (object.is_object()) object["id"] = mgtd::calib::calibration::content_id(object);
  const auto calibration = mgtd::calib::calibration::calibration_from_json(object);
  if (!calibration) {
    require(!calibration.error().message.empty() && !calibration.error().remedy.empty());
    return 0;
  }
  for (const auto& sensor : calibration->sensors) require(sensor.parameters().allFinite());
  require(mgtd::calib::calibration::full_covariance(*calibration).allFinite());
  const auto again =
      mgtd::calib::calibration::calibration_from_json(mgtd::calib::calibration::to_json(*calibration));
  require(again.has_value() &&
          mgtd::calib::calibration::to_json(*again) == mgtd::calib::calibration::to_json(*calibration));
  return 0;
}
