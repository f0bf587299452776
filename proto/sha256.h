// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

/// This computes the SHA-256 (FIPS 180-4) of a text, as 64 lower-case hex digits. It names data and
/// calibrations; it guards no secret.
namespace mgtd {

[[nodiscard]] std::string sha256_hex(std::string_view data);

}  // namespace mgtd
