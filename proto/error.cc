// SPDX-License-Identifier: Apache-2.0
#include "proto/error.h"

#include <array>

namespace mgtd {
namespace {

constexpr std::array<std::string_view, 8> kNames{"usage",       "bad_input", "refused", "io",
                                                 "unreachable", "protocol",  "state",   "internal"};

}  // namespace

std::string_view name(ErrorCode code) { return kNames.at(static_cast<std::size_t>(code)); }

ErrorCode error_code_from_name(std::string_view name) {
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (kNames[i] == name) return static_cast<ErrorCode>(i);
  }
  return ErrorCode::internal;
}

}  // namespace mgtd
