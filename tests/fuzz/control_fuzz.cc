// SPDX-License-Identifier: Apache-2.0
// Whatever a control client sends, and whatever answers a control client: a request that is accepted survives
// its encoding, and a refusal can be sent back and read.
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string_view>

#include "proto/calibration_request.h"
#include "proto/control_codec.h"
#include "proto/run_request.h"
#include "proto/status_codec.h"
#include "tests/fuzz/require.h"

namespace {

using mgtd::testing::require;

void as_request(std::string_view line) {
  const auto request = mgtd::parse_control(line);
  if (!request) {
    const auto reply = mgtd::parse_reply(
        mgtd::encode_reply(request.error().id, tl::unexpected<mgtd::Error>(request.error().error)));
    require(reply && !reply->result);
    return;
  }
  require(mgtd::parse_control(mgtd::encode(*request)).has_value());
  if (const auto run = mgtd::parse_run_request(request->args)) {
    const auto back = mgtd::parse_run_request(mgtd::to_json(*run));
    require(back && *back == *run);
  }
  static_cast<void>(mgtd::parse_accept_request(request->args));
  static_cast<void>(mgtd::parse_import_request(request->args));
}

void as_reply(std::string_view line) {
  const auto reply = mgtd::parse_reply(line);
  if (reply && reply->result) static_cast<void>(mgtd::run_status_from_json(*reply->result));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view line(reinterpret_cast<const char*>(data), size);
  if (size > mgtd::kControlLineLimit) return 0;
  as_request(line);
  as_reply(line);
  return 0;
}
