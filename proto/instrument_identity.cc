// SPDX-License-Identifier: Apache-2.0
#include "proto/instrument_identity.h"

namespace mgtd {

std::string_view serial_of(const InstrumentIdentity& who) {
  constexpr std::string_view kMark = ", serial ";
  const std::string_view told = who.identity;
  const auto at = told.rfind(kMark);
  return at == std::string_view::npos ? std::string_view{} : told.substr(at + kMark.size());
}

}  // namespace mgtd
