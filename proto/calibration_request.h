// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "proto/error.h"

/// These functions read the arguments of the control commands calibrations.show, calibrations.accept,
/// calibrations.reject and calibrations.import.
namespace mgtd {

/// {"id":".."}; refuses an empty one.
[[nodiscard]] Result<std::string> parse_calibration_id(const nlohmann::json& args);

/// {"id":"..","force":true,"why":".."}
struct AcceptRequest {
  std::string id;
  bool force{false};  ///< also a calibration that failed its checks or was rejected
  std::string why{};  ///< the operator's reason, kept with it
};
[[nodiscard]] Result<AcceptRequest> parse_accept_request(const nlohmann::json& args);

/// {"id":"..","why":".."}; refuses an empty reason.
struct RejectRequest {
  std::string id, why;
};
[[nodiscard]] Result<RejectRequest> parse_reject_request(const nlohmann::json& args);

/// {"calibration":{CAL.json},"origin":"cal.json","accept":true,"force":false}
struct ImportRequest {
  nlohmann::json calibration;
  std::string origin;  ///< what `calibrations list` shall say it came from
  bool accept{false};  ///< and make it the active one
  bool force{false};
};
/// What is in the calibration is not looked at here.
[[nodiscard]] Result<ImportRequest> parse_import_request(const nlohmann::json& args);

}  // namespace mgtd
