// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <string_view>

#include "tests/support/device_bench.h"

/// Plays an arbitrary life of a device: each record is an operation byte (what happens), a length and bytes.
/// The books must balance whatever happens; `request` does what is peculiar to the device.
namespace mgtd::testing {

inline void live_through(drivers::Device& device, const std::uint8_t* data, std::size_t size,
                         const std::function<void(std::uint8_t)>& request = {}) {
  DeviceBench bench(device);
  bench.open();
  bool open = true;
  std::string_view rest(reinterpret_cast<const char*>(data), size);
  while (rest.size() >= 2) {
    const auto what = static_cast<std::uint8_t>(rest[0]);
    const std::size_t length = std::min<std::size_t>(static_cast<std::uint8_t>(rest[1]), rest.size() - 2);
    if (what == 0) {
      open ? bench.close() : bench.open();
      open = !open;
    } else if (what < 32) {
      bench.pass(0.2 * what);
    } else if (what < 64 && request) {
      request(what);
      bench.exchange();
    }
    if (open) bench.feed(rest.substr(2, length));
    bench.forget_events();
    bench.forget_sent();
    if (!device.health().balanced()) std::abort();
    rest.remove_prefix(2 + length);
  }
}

}  // namespace mgtd::testing
