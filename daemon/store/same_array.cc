// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/same_array.h"

#include <fmt/format.h>

#include "calib/report/described_array.h"

namespace mgtd::daemon::store {

Result<void> same_array(const PlacedFile& a, const PlacedFile& b, const std::string& remedy) {
  if (a.places.agrees_with(b.places)) return {};
  const auto [first, second] = calib::report::names_apart(a.places, b.places);
  return fail(ErrorCode::bad_input,
              fmt::format("{} is of {}, and {} of {}: this is another array", a.name, first, b.name, second),
              remedy);
}

}  // namespace mgtd::daemon::store
