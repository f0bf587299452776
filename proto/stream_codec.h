// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

#include "proto/array_description.h"
#include "proto/epoch.h"
#include "proto/error.h"
#include "proto/run_status.h"
#include "proto/sensors_report.h"
#include "proto/status_report.h"

/// encode() writes every line of the live stream but TENSOR (tensor_encoder.h), as one JSON object without
/// the line end.
///
///   {"class":"HELLO","protocol":{"major":1,"minor":2},"rig":"..","software":"mgtd 0.1.0","array":{...}}
///   {"class":"GAP","from_seq":..,"to_seq":..,"why":".."}
///   {"class":"ERROR","message":"..","remedy":".."}
///   {"class":"STATUS",...}  {"class":"RUN",...}      keys as in status_codec.h, array_description.h
///   {"class":"SENSORS",...}                          keys as in sensors_report.h
namespace mgtd {

/// Major changes when an old client would misread the stream, minor when keys or classes were added.
inline constexpr int kStreamProtocolMajor = 1;
inline constexpr int kStreamProtocolMinor = 2;

struct Greeting {
  std::string rig;
  std::string software;
  ArrayDescription array{};
};

[[nodiscard]] std::string encode(const Greeting& greeting);
[[nodiscard]] std::string encode(const Gap& gap);
[[nodiscard]] std::string encode(const Error& error);
[[nodiscard]] std::string encode(const StatusReport& report);
[[nodiscard]] std::string encode(const RunStatus& run);
[[nodiscard]] std::string encode(const SensorsReport& sensors);

}  // namespace mgtd
