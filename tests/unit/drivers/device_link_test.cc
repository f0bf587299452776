// SPDX-License-Identifier: Apache-2.0
#include "drivers/device_link.h"

#include <gtest/gtest.h>

#include <memory>
#include <utility>

namespace mgtd::drivers {
namespace {

/// Is in the state that the test wants.
class Puppet final : public Device {
 public:
  void be(LinkState state, std::string detail = {}) {
    health_.state = state;
    health_.detail = std::move(detail);
  }
  void on_open(Stamp /*now*/) override { be(LinkState::probing); }
  void on_bytes(std::span<const std::byte> /*bytes*/, Stamp /*arrival*/) override {}
  void on_tick(Stamp /*now*/) override {}
  void on_close(Stamp /*now*/) override {}
  [[nodiscard]] int baud() const override { return 9600; }
};

Stamp second(double t_s) { return {Instant{from_seconds(t_s)}, {}}; }

TEST(DeviceLink, KnowsSinceWhenItsStateIsWhatItIs) {
  const auto puppet = std::make_shared<Puppet>();
  DeviceLink link(puppet, {});
  EXPECT_FALSE(link.health().state_since) << "nothing happened yet";
  link.refused({ErrorCode::unreachable, "/dev/x: there is no such port", "plug it in"}, second(1));
  EXPECT_EQ(link.health().state, LinkState::absent);
  EXPECT_EQ(link.health().state_since, second(1).mono);
  link.opened(second(5));
  EXPECT_EQ(link.health().state_since, second(5).mono);
  puppet->be(LinkState::live);
  link.tick(second(6));
  puppet->be(LinkState::live, "with another detail");
  link.tick(second(7));
  EXPECT_EQ(link.health().state_since, second(6).mono) << "the state is the same";
  link.lost("/dev/x: the port is gone", second(9));
  EXPECT_EQ(link.health().state, LinkState::gone);
  EXPECT_EQ(link.health().state_since, second(9).mono);
}

TEST(DeviceLink, WhoeverIsToldOfAStateIsToldItsTime) {
  const auto puppet = std::make_shared<Puppet>();
  std::optional<Instant> told;
  DeviceLink link(puppet, {.on_send = {},
                           .on_events = {},
                           .on_state = [&](const LinkHealth& health, Stamp) { told = health.state_since; },
                           .on_raw = {}});
  link.opened(second(2));
  EXPECT_EQ(told, second(2).mono);
  puppet->be(LinkState::silent);
  link.tick(second(3));
  EXPECT_EQ(told, second(3).mono);
}

}  // namespace
}  // namespace mgtd::drivers
