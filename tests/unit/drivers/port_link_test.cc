// SPDX-License-Identifier: Apache-2.0
#include "drivers/port_link.h"

#include <gtest/gtest.h>

#include <boost/asio/io_context.hpp>
#include <chrono>
#include <optional>
#include <string>

#include "drivers/line_device.h"
#include "tests/support/child_process.h"
#include "tests/support/pty.h"

namespace mgtd::drivers {
namespace {

using mgtd::testing::PtyMaster;

/// Greets on opening, notes every line, says goodbye.
class Parrot final : public LineDevice {
 public:
  Parrot() : LineDevice({Ending::lf, 100, 115200, 0.2}) {}
  void on_open(Stamp now) override {
    LineDevice::on_open(now);
    send("hello\n");
  }
  void on_tick(Stamp now) override {
    ++ticks;
    if (impatient) LineDevice::on_tick(now);
  }
  void on_close(Stamp now) override {
    LineDevice::on_close(now);
    emit(DeviceNote{now, "alas"});
  }
  void on_shutdown(Stamp /*now*/) override { send("bye\n"); }
  void say(std::string_view text) { send(text); }
  void note(std::string text) { emit(DeviceNote{{}, std::move(text)}); }
  int ticks{0};
  bool impatient{false};  ///< wants a fresh port when nothing comes

 protected:
  FrameResult on_line(std::string_view line, Stamp arrival) override {
    set_state(line == "mute" ? LinkState::silent : LinkState::live, std::string(line));
    emit(DeviceNote{arrival, std::string(line)});
    return FrameResult::accepted();
  }
};

class PortLinkTest : public ::testing::Test {
 protected:
  /// Runs the loop until the condition holds.
  bool until(const std::function<bool()>& condition) {
    return mgtd::testing::eventually([&] {
      io_.restart();
      io_.run_for(std::chrono::milliseconds(1));
      return condition();
    });
  }
  std::unique_ptr<PortLink> link(const std::string& path) {
    device_ = std::make_shared<Parrot>();
    link_ = std::make_unique<DeviceLink>(
        device_, LinkCallbacks{[this](std::string_view bytes) { port_->send(bytes); },
                               [this](const std::vector<DeviceEvent>& events, Stamp) {
                                 if (!states_.empty()) told_ = states_.back().state;
                                 for (const auto& event : events)
                                   lines_.push_back(std::get<DeviceNote>(event).what);
                               },
                               [this](const LinkHealth& health, Stamp) { states_.push_back(health); },
                               [this](Direction direction, std::span<const std::byte> bytes, Stamp) {
                                 (direction == Direction::in ? raw_in_ : raw_out_)
                                     .append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
                               }});
    auto port = std::make_unique<PortLink>(io_, clock_, PortSettings{path, 0}, *link_);
    port_ = port.get();
    return port;
  }

  mgtd::testing::TemporaryDirectory directory_;
  std::string path_{directory_ / "port"};
  boost::asio::io_context io_;
  Clock clock_{10};  ///< so that what is a matter of seconds does not take them
  std::shared_ptr<Parrot> device_;
  std::unique_ptr<DeviceLink> link_;
  PortLink* port_{nullptr};
  std::vector<std::string> lines_;
  std::vector<LinkHealth> states_;
  LinkState told_{LinkState::opening};  ///< state known when the last event came
  std::string raw_in_, raw_out_;
};

TEST_F(PortLinkTest, CarriesBytesBothWaysAndJournalsThem) {
  PtyMaster master(path_);
  auto port = link(path_);
  port->start();
  ASSERT_TRUE(until([&] { return master.received() == "hello\n"; }));
  master.write("one\ntw");
  ASSERT_TRUE(until([&] { return lines_.size() == 1; }));
  master.write("o\n");
  ASSERT_TRUE(until([&] { return lines_ == std::vector<std::string>{"one", "two"}; }));
  EXPECT_EQ(raw_in_, "one\ntwo\n");
  EXPECT_EQ(raw_out_, "hello\n");
  EXPECT_EQ(link_->health().state, LinkState::live);
  EXPECT_TRUE(link_->health().balanced());
  EXPECT_TRUE(until([&] { return device_->ticks > 3; }));
}

TEST_F(PortLinkTest, FlushSendsWhatWasAskedOfTheDevice) {
  PtyMaster master(path_);
  auto port = link(path_);
  port->start();
  const std::string much(100'000, 'x');  // more than a pty holds: the write queue must wait, in order
  device_->say(much);
  device_->say("end\n");
  link_->flush(clock_.now());
  ASSERT_TRUE(until([&] { return master.received() == "hello\n" + much + "end\n"; }));
}

TEST_F(PortLinkTest, WhatARequestProvokesIsToldAtOnce) {
  PtyMaster master(path_);
  auto port = link(path_);
  port->start();
  device_->note("refused");
  link_->flush(clock_.now());
  EXPECT_EQ(lines_, std::vector<std::string>{"refused"});
}

TEST_F(PortLinkTest, APortThatIsNotThereIsAwaited) {
  auto port = link(path_);
  port->start();
  ASSERT_TRUE(until([&] { return !states_.empty(); }));
  EXPECT_EQ(states_.back().state, LinkState::absent);
  EXPECT_NE(states_.back().detail.find("there is no such port"), std::string::npos);
  PtyMaster master(path_);
  ASSERT_TRUE(until([&] { return master.received() == "hello\n"; }));
}

TEST_F(PortLinkTest, UnplugAndReplugStartOver) {
  std::optional<PtyMaster> master(path_);
  auto port = link(path_);
  port->start();
  ASSERT_TRUE(until([&] { return master->received() == "hello\n"; }));
  master->write("half a li");
  ASSERT_TRUE(until([&] { return link_->health().bytes_in == 9; }));
  master.reset();
  ASSERT_TRUE(until([&] { return link_->health().state == LinkState::gone; }));
  EXPECT_TRUE(link_->health().balanced());
  EXPECT_EQ(link_->health().closes, 1U);
  EXPECT_EQ(lines_, std::vector<std::string>{"alas"});
  EXPECT_EQ(told_, LinkState::gone) << "the loss is told first";
  master.emplace(path_);
  ASSERT_TRUE(until([&] { return master->received() == "hello\n"; }));
  EXPECT_EQ(link_->health().opens, 2U);
  master->write("ne\n");
  ASSERT_TRUE(until([&] { return lines_ == (std::vector<std::string>{"alas", "ne"}); }));
}

/// A run that hears of the fault first waits for its operator instead of for the device.
TEST_F(PortLinkTest, ThatADeviceNoLongerAnswersIsToldBeforeWhatItSaysAboutIt) {
  PtyMaster master(path_);
  auto port = link(path_);
  port->start();
  master.write("one\n");
  ASSERT_TRUE(until([&] { return !states_.empty() && states_.back().state == LinkState::live; }));
  master.write("mute\n");
  ASSERT_TRUE(until([&] { return lines_.size() == 2; }));
  EXPECT_EQ(told_, LinkState::silent);
}

TEST_F(PortLinkTest, ADeviceThatAsksForItIsOpenedAgain) {
  PtyMaster master(path_);
  auto port = link(path_);
  port->start();
  ASSERT_TRUE(until([&] { return master.received() == "hello\n"; }));
  device_->impatient = true;
  ASSERT_TRUE(until([&] { return link_->health().closes == 1; }));
  device_->impatient = false;
  ASSERT_TRUE(until([&] { return master.received() == "hello\nhello\n"; }));
}

TEST_F(PortLinkTest, LastWordsAreSent) {
  PtyMaster master(path_);
  auto port = link(path_);
  port->start();
  ASSERT_TRUE(until([&] { return master.received() == "hello\n"; }));
  port->shutdown();
  EXPECT_EQ(link_->health().state, LinkState::absent);
  ASSERT_TRUE(until([&] { return master.received() == "hello\nbye\n"; }));
  EXPECT_EQ(raw_out_, "hello\nbye\n");
}

}  // namespace
}  // namespace mgtd::drivers
