// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "drivers/settings.h"
#include "proto/error.h"

/// The identity of a device tells it from others of its kind: four digitisers of one make differ in their
/// serial number only. A configuration that states it (`serial`) has the device on the port refused when it
/// is another.
namespace mgtd::drivers {

/// The key `serial`; empty when it is not stated. Mistakes are left in `settings`.
[[nodiscard]] std::string read_serial(Settings& settings);

/// Refused (ErrorCode::refused) with both numbers and what to do. `told`: the device's own; empty when it
/// does not say.
[[nodiscard]] Result<void> check_serial(std::string_view stated, std::string_view reported);

/// "0123" of "SN0123", or all of a reply without SN.
[[nodiscard]] std::string serial_after_sn(std::string_view line);
/// The third field of the answer to *IDN?: maker, model, serial number, firmware.
[[nodiscard]] std::string serial_of_idn(std::string_view line);
/// The word after the model in the header a GSM prints: "Gem Systems GSM-19W 3101329 v6.0 ...".
[[nodiscard]] std::string serial_of_gsm(std::string_view header);

}  // namespace mgtd::drivers
