// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

/// An InstrumentIdentity says which instrument answers in a place of the rig, as far as the wire tells.
namespace mgtd {

struct InstrumentIdentity {
  std::string place;     ///< "s1" .. "s4", "table", "scalar"
  std::string identity;  ///< LinkHealth::identity: as it names itself, with its serial number where it tells
  bool operator==(const InstrumentIdentity&) const = default;
};

/// "1002" of "obsDAQ V5.5.7, serial 1002"; empty: it does not tell.
[[nodiscard]] std::string_view serial_of(const InstrumentIdentity& who);

}  // namespace mgtd
