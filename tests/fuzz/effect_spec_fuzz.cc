// SPDX-License-Identifier: Apache-2.0
// Whatever an operator types behind --with: a spec that is accepted reads back from its own text.
#include <cstdint>
#include <string_view>

#include "calib/effects/effect_spec.h"
#include "tests/fuzz/require.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using mgtd::testing::require;
  const auto spec =
      mgtd::calib::effects::EffectSpec::parse(std::string_view(reinterpret_cast<const char*>(data), size));
  if (!spec) {
    require(!spec.error().message.empty());
    return 0;
  }
  const auto again = mgtd::calib::effects::EffectSpec::parse(spec->text());
  require(again.has_value() && again->text() == spec->text());
  return 0;
}
