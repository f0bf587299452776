// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>

#include "calib/calibration/calibration.h"

/// These functions write a calibration as JSON (CAL.json, schema "mgt.cal/1") and read it back. Every key
/// names its unit; angles are radians here, since degrees would cost the last bit. Covariance in the same
/// units, upper triangle by rows. Reading gives the same bits back.
namespace mgtd::calib::calibration {

[[nodiscard]] nlohmann::json to_json(const Calibration& calibration);
[[nodiscard]] nlohmann::json to_json(const std::vector<Check>& checks);
/// "c" and the first 12 hex digits of the SHA-256 of everything but the key "id".
[[nodiscard]] std::string content_id(nlohmann::json object);
[[nodiscard]] Result<Calibration> calibration_from_json(const nlohmann::json& object);

}  // namespace mgtd::calib::calibration
