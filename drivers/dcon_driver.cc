// SPDX-License-Identifier: Apache-2.0
#include "drivers/dcon_driver.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "drivers/baud.h"

namespace mgtd::drivers::dcon {
namespace {

constexpr double kAnswer_s = 0.5;
constexpr int kFairTicks = 10;
constexpr int kMissed = 3;
constexpr double kReopen_s = 30;
constexpr std::size_t kLongestLine = 160;  // 16 channels of 8 characters, with room
constexpr std::size_t kMaxChannels = 16;

bool is_column(std::string_view name) {
  constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";
  return kLetters.find(name.front()) != std::string_view::npos &&
         std::all_of(name.begin(), name.end(), [&](char c) {
           return c == '_' || (c >= '0' && c <= '9') || kLetters.find(c) != std::string_view::npos;
         });
}

/// s1_T_degC .. s4_T_degC
std::optional<int> sensor_of(std::string_view column) {
  if (column.size() != 9 || column.front() != 's' || column.substr(2) != "_T_degC") return std::nullopt;
  const int slot = column[1] - '1';
  return slot >= 0 && slot < kSensors ? std::optional(slot) : std::nullopt;
}

bool is_hexadecimal(std::string_view text) {
  return text.find_first_not_of("0123456789ABCDEF") == std::string_view::npos;
}

void read_channels(Settings& s, std::vector<Channel>& out) {
  std::set<std::string> seen;
  for (const std::string& column : s.texts("channels")) {
    if (!column.empty() && !is_column(column))
      s.object("channels",
               fmt::format("'{}' is no column's name: letters, digits and _, a letter first", column));
    if (!column.empty() && !seen.insert(column).second)
      s.object("channels", fmt::format("'{}' stands there twice", column));
    out.push_back({column, 1, 0, sensor_of(column)});
  }
  if (seen.empty() || out.size() > kMaxChannels) {
    s.object("channels", R"(must name the column of each input, 1 to 16: ["motor_A", "", "s3_T_degC"])");
    return;
  }
  const std::vector<double> scale = s.numbers("scale", out.size(), std::vector<double>(out.size(), 1.0));
  const std::vector<double> offset = s.numbers("offset", out.size(), std::vector<double>(out.size(), 0.0));
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i].scale = scale[i];
    out[i].offset = offset[i];
  }
}

}  // namespace

DconSettings read_dcon_settings(Settings& s) {
  DconSettings out;
  out.baud = read_baud(s, kDefaultBaud);
  out.address = s.text("address", out.address);
  if (out.address.size() != 2 || !is_hexadecimal(out.address))
    s.object("address", "must be two hexadecimal digits, like \"01\" or \"0A\"");
  out.checksum = s.boolean("checksum", out.checksum);
  out.every_s = s.number("every_s", out.every_s);
  if (!(out.every_s >= 0.2 && out.every_s <= 60)) s.object("every_s", "must be 0.2 to 60 s");
  read_channels(s, out.channels);
  return out;
}

DconDriver::DconDriver(DconSettings settings)
    : LineDevice({Ending::cr, kLongestLine, settings.baud, kReopen_s}), settings_(std::move(settings)) {}

std::unique_ptr<Device> DconDriver::make(int /*slot*/, Settings& settings) {
  return std::make_unique<DconDriver>(read_dcon_settings(settings));
}

void DconDriver::on_open(Stamp now) {
  LineDevice::on_open(now);
  named_ = false;
  missed_ = 0;
  next_.clear();
  ask(fmt::format("${}M", settings_.address), now.mono);
}

void DconDriver::ask(std::string_view what, Instant now) {
  send(command(std::string(what), settings_.checksum));
  answer_.set(now, kAnswer_s, kFairTicks);
}

void DconDriver::on_tick(Stamp now) {
  LineDevice::on_tick(now);
  if (health_.state == LinkState::absent) return;
  if (answer_.passed(now.mono)) {
    answer_.clear();
    unanswered(now);
  }
  if (!next_.passed(now.mono)) return;
  next_.set(now.mono, settings_.every_s, kFairTicks);
  ask(fmt::format("#{}", settings_.address), now.mono);
}

void DconDriver::unanswered(Stamp now) {
  if (!std::exchange(named_, true)) return next_.set(now.mono, 0, 1);  // an old module has no name
  if (++missed_ != kMissed) return;
  set_state(LinkState::silent,
            fmt::format("{} questions without an answer; check power, the pair A/B of the RS-485, address "
                        "({}), baud ({}) and whether its checksum is on ({} here)",
                        kMissed, settings_.address, baud(), settings_.checksum ? "on" : "off"));
  emit(DeviceNote{now, health_.detail});
}

Verdict DconDriver::on_line(std::string_view line, Stamp arrival) {
  const Reply reply = parse_reply(line, settings_.address, settings_.checksum);
  if (const auto* why = std::get_if<Reject>(&reply)) return Verdict::rejected(*why);
  answer_.clear();
  missed_ = 0;
  if (const auto* name = std::get_if<Name>(&reply)) {
    health_.identity = name->text;
    if (!std::exchange(named_, true)) next_.set(arrival.mono, 0, 1);
    return Verdict::accepted();
  }
  if (const auto* values = std::get_if<Values>(&reply)) return on_values(*values, arrival);
  return on_refusal(arrival);
}

Verdict DconDriver::on_refusal(Stamp arrival) {
  if (!std::exchange(named_, true)) {
    next_.set(arrival.mono, 0, 1);
    return Verdict::accepted();
  }
  set_state(LinkState::failed, "the module refuses to be read (?" + settings_.address +
                                   "): it is no analogue input module, or its firmware is another");
  return Verdict::accepted();
}

Verdict DconDriver::on_values(const Values& values, Stamp arrival) {
  if (values.channels.size() < settings_.channels.size()) {
    set_state(LinkState::failed,
              fmt::format("the module sends {} channels, {} are configured; shorten 'channels'",
                          values.channels.size(), settings_.channels.size()));
    return Verdict::rejected(Reject::length);
  }
  AuxiliaryReading auxiliary{arrival, {}};
  for (std::size_t i = 0; i < settings_.channels.size(); ++i) {
    const Channel& channel = settings_.channels[i];
    if (channel.column.empty() || !values.channels[i]) continue;
    const double value = channel.scale * *values.channels[i] + channel.offset;
    if (channel.slot)
      emit(TemperatureReading{*channel.slot, arrival, value, std::nullopt, std::nullopt});
    else
      auxiliary.values.emplace_back(channel.column, value);
  }
  if (!auxiliary.values.empty()) emit(std::move(auxiliary));
  if (health_.state != LinkState::live) set_state(LinkState::live, "reading its inputs");
  return Verdict::accepted();
}

}  // namespace mgtd::drivers::dcon
