// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "proto/error.h"
#include "proto/time.h"

/// One client controls, many look; this says who has control now, and how a client asks to keep it.
///
///   "holder": {"pid","uid","via","since","taken","why","left_s"}: null when nobody has control
///
/// `taken`: asked for with control.take; else it comes with a request that changed something. `left_s`: until
/// control is free again if the holder says nothing more.
namespace mgtd {

struct ControlHolder {
  std::int64_t pid{0};  ///< 0: not known, e.g. of another container
  std::int64_t uid{0};
  std::string via{};  ///< "the console, from 127.0.0.1"; empty: the control socket
  WallTime since;
  bool taken{false};
  std::string why;
  double left_s{0};
};

[[nodiscard]] nlohmann::ordered_json to_json(const std::optional<ControlHolder>& holder);

/// Arguments of control.take: {"why":"..","idle_s":600}, both may be left out.
struct TakeRequest {
  std::string why;
  double idle_s{600};  ///< of silence, then control is free again: 1 to 86400
};
[[nodiscard]] Result<TakeRequest> parse_take_request(const nlohmann::json& args);

}  // namespace mgtd
