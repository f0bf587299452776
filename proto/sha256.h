// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

/// sha256_hex() computes the SHA-256 (FIPS 180-4) of a text, as 64 lower-case hex digits. It names data and
/// calibrations; it guards no secret. OpenSSL computes it.
namespace mgtd {

/// Throws std::runtime_error where the OpenSSL of the system has its default provider turned off.
[[nodiscard]] std::string sha256_hex(std::string_view data);

}  // namespace mgtd
