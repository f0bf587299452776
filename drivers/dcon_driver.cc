// SPDX-License-Identifier: Apache-2.0
#include "drivers/dcon_driver.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "drivers/baud.h"

namespace mgtd::drivers::dcon {
namespace {

constexpr double kFirstAnswer_s = 0.5;  ///< an old module has no name
constexpr double kAnswer_s = 2.5;
constexpr int kFairTicks = 10;
constexpr int kMissed = 3;
constexpr double kDconReopen_s = 30;
constexpr std::size_t kLongestDconLine = 160;  // 16 channels of 8 characters, with room

bool is_hexadecimal(std::string_view text) {
  return text.find_first_not_of("0123456789ABCDEF") == std::string_view::npos;
}

void read_channels(Settings& s, DconSettings& out) {
  const std::vector<std::string> columns = s.texts("channels");
  out.inputs = columns.size();
  if (columns.size() > kMaxChannels ||
      std::all_of(columns.begin(), columns.end(), [](const std::string& c) { return c.empty(); })) {
    s.object("channels", R"(must name the column of each input, 1 to 16: ["motor_A", "", "s3_T_degC"])");
    return;
  }
  const std::vector<double> scale = s.numbers("scale", out.inputs, std::vector<double>(out.inputs, 1.0));
  const std::vector<double> offset = s.numbers("offset", out.inputs, std::vector<double>(out.inputs, 0.0));
  const std::vector<std::string> units = s.texts("units");
  if (!units.empty() && units.size() != columns.size())
    s.object("units", fmt::format("must be a list of {} texts, one for each of 'channels'", columns.size()));
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i].empty()) continue;
    InputChannel channel{i, std::to_string(i), "channels", columns[i], {}, scale[i], offset[i]};
    channel.unit = i < units.size() ? units[i] : std::string(unit_of_name(columns[i]));
    check_column(channel, s);
    out.channels.push_back(std::move(channel));
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
  read_channels(s, out);
  return out;
}

DconDriver::DconDriver(DconSettings settings)
    : LineDevice({Ending::cr, kLongestDconLine, settings.baud, kDconReopen_s}),
      settings_(std::move(settings)) {
  for (const InputChannel& channel : settings_.channels)
    settings_.inputs = std::max(settings_.inputs, channel.index + 1);
}

std::unique_ptr<Device> DconDriver::make(int /*slot*/, Settings& settings) {
  return std::make_unique<DconDriver>(read_dcon_settings(settings));
}

void DconDriver::on_open(Stamp now) {
  LineDevice::on_open(now);
  proved_ = false;
  has_name_ = true;
  missed_ = 0;
  strange_.clear();
  next_.clear();
  ask(Asked::name, kFirstAnswer_s, now.mono);
}

void DconDriver::ask(Asked what, double patience_s, Instant now) {
  asked_ = what;
  const std::string question = what == Asked::name ? "$" + settings_.address + "M" : "#" + settings_.address;
  send(command(question, settings_.checksum));
  answer_.set(now, patience_s, kFairTicks);
}

void DconDriver::on_tick(Stamp now) {
  LineDevice::on_tick(now);
  if (health_.state == LinkState::absent) return;
  if (asked_ != Asked::nothing && answer_.passed(now.mono)) unanswered(now);
  const bool due = next_.passed(now.mono);
  if (!due || asked_ != Asked::nothing) return;
  if (proved_) next_.set(now.mono, settings_.every_s, kFairTicks);
  ask(proved_ ? Asked::values : Asked::name, kAnswer_s, now.mono);
}

void DconDriver::unanswered(Stamp now) {
  const bool first = asked_ == Asked::name && !proved_ && missed_ == 0;
  if (asked_ == Asked::name && first) has_name_ = false;
  proved_ = asked_ == Asked::name && !has_name_;
  asked_ = Asked::nothing;
  next_.set(now.mono, 0, 1);
  if (first || ++missed_ != kMissed) return;
  if (strange_.empty()) {
    set_state(LinkState::silent,
              fmt::format("{} questions without an answer; check power, the pair A/B of the RS-485, address "
                          "({}), baud ({}) and whether its checksum is on ({} here)",
                          kMissed, settings_.address, baud(), settings_.checksum ? "on" : "off"));
  } else {
    set_state(LinkState::failed,
              fmt::format("wrong device on the port? It says '{}', which is no answer of a module with the "
                          "address {} and its checksum {}; check which device is on this port",
                          strange_, settings_.address, settings_.checksum ? "on" : "off"));
  }
  emit(DeviceNote{now, health_.detail});
}

void DconDriver::answered(Instant now) {
  if (asked_ == Asked::name) next_.set(now, 0, 1);
  asked_ = Asked::nothing;
  proved_ = true;
  missed_ = 0;
  strange_.clear();
}

FrameResult DconDriver::unasked() {
  proved_ = false;
  return FrameResult::resync();
}

FrameResult DconDriver::on_line(std::string_view line, Stamp arrival) {
  const Reply reply = parse_reply(line, settings_.address, settings_.checksum);
  if (const auto* why = std::get_if<Reject>(&reply)) {
    strange_ = line;
    return FrameResult::rejected(*why);
  }
  if (const auto* name = std::get_if<Name>(&reply)) return on_name(*name, arrival);
  if (const auto* values = std::get_if<Values>(&reply)) return on_values(*values, arrival);
  return on_refusal(arrival);
}

FrameResult DconDriver::on_name(const Name& name, Stamp arrival) {
  if (asked_ != Asked::name) return unasked();
  health_.identity = name.text;
  has_name_ = true;
  answered(arrival.mono);
  return FrameResult::accepted();
}

FrameResult DconDriver::on_refusal(Stamp arrival) {
  if (asked_ == Asked::nothing) return unasked();
  const bool of_the_name = asked_ == Asked::name;
  answered(arrival.mono);
  if (of_the_name) return FrameResult::accepted();
  set_state(LinkState::failed, "the module refuses to be read (?" + settings_.address +
                                   "): it is no analogue input module, or its firmware is another");
  return FrameResult::accepted();
}

FrameResult DconDriver::on_values(const Values& values, Stamp arrival) {
  if (asked_ != Asked::values) return unasked();
  answered(arrival.mono);
  if (values.channels.size() < settings_.inputs) {
    set_state(LinkState::failed,
              fmt::format("the module sends {} channels, {} are configured; shorten 'channels'",
                          values.channels.size(), settings_.inputs));
    return FrameResult::rejected(Reject::length);
  }
  report_inputs(settings_.channels, values.channels, arrival,
                [this](DeviceEvent event) { emit(std::move(event)); });
  if (health_.state != LinkState::live) set_state(LinkState::live, "reading its inputs");
  return FrameResult::accepted();
}

}  // namespace mgtd::drivers::dcon
