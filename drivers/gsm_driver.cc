// SPDX-License-Identifier: Apache-2.0
#include "drivers/gsm_driver.h"

#include <fmt/format.h>

#include <utility>

#include "drivers/baud.h"
#include "drivers/identity.h"

namespace mgtd::drivers::gsm {
namespace {

constexpr double kInitPause_s = 1.2;
constexpr double kGsmReopen_s = 60.0;  ///< slow instruments are allowed long silences
constexpr std::size_t kLongestGsmLine = 256;
constexpr std::string_view kUtc = "{utc}";

}  // namespace

GsmSettings read_gsm_settings(Settings& s) {
  GsmSettings out;
  out.baud = read_baud(s, kDefaultBaud);
  out.serial = read_serial(s);
  out.init = s.texts("init");
  const std::vector<double> range = s.numbers("range_nT", 2, {out.min_nT, out.max_nT});
  out.min_nT = range[0];
  out.max_nT = range[1];
  if (!(out.min_nT >= 0 && out.min_nT < out.max_nT)) s.object("range_nT", "must be [lowest, highest] in nT");
  out.silence_s = s.number("silence_s", out.silence_s);
  if (!(out.silence_s >= 1)) s.object("silence_s", "must be 1 s or more");
  return out;
}

GsmDriver::GsmDriver(GsmSettings settings)
    : LineDevice({Ending::lf, kLongestGsmLine, settings.baud, kGsmReopen_s}),
      settings_(std::move(settings)) {}

std::unique_ptr<Device> GsmDriver::make(int /*slot*/, Settings& settings) {
  return std::make_unique<GsmDriver>(read_gsm_settings(settings));
}

void GsmDriver::on_open(Stamp now) {
  LineDevice::on_open(now);
  set_state(LinkState::probing, "waiting for the first reading");
  another_.reset();
  last_text_.clear();
  next_init_ = 0;
  silence_.set(now.mono, settings_.silence_s + kInitPause_s * static_cast<double>(settings_.init.size()));
  send_init(now);
}

void GsmDriver::send_init(Stamp now) {
  if (next_init_ == settings_.init.size()) return;
  const std::string& text = settings_.init[next_init_++];
  send(text == kUtc ? clock_string(now.wall) : text);
  next_.set(now.mono, kInitPause_s, 2);
}

void GsmDriver::on_tick(Stamp now) {
  LineDevice::on_tick(now);
  if (health_.state == LinkState::absent) return;
  if (next_.passed(now.mono)) {
    next_.clear();
    send_init(now);
  }
  if (another_ || !silence_.passed(now.mono)) return;
  silence_.clear();
  const bool talks_on =
      !last_text_.empty() && now.mono - last_text_at_ < from_seconds(settings_.silence_s / 3);
  const std::string heard = last_text_.empty() ? "" : fmt::format(", last heard '{}'", last_text_);
  set_state(
      talks_on ? LinkState::failed : LinkState::silent,
      fmt::format(
          "no reading for {:.0f} s{}; {}", settings_.silence_s, heard,
          talks_on ? fmt::format("wrong device on the port? Check which device it is, and baud ({})", baud())
                   : fmt::format("check power, cable, baud ({}) and that the instrument sends in real "
                                 "time (its memory may be full)",
                                 baud())));
  emit(DeviceNote{now, health_.detail});
}

FrameResult GsmDriver::on_line(std::string_view line, Stamp arrival) {
  const GsmLine parsed = parse_line(line);
  if (const auto* reading = std::get_if<GsmReading>(&parsed)) return on_reading(*reading, arrival);
  last_text_ = line;
  last_text_at_ = arrival.mono;
  if (const auto* why = std::get_if<Reject>(&parsed)) return FrameResult::rejected(*why);
  if (line.find("z-save") != std::string_view::npos) send("z");
  if (std::get<GsmText>(parsed).header && line.find("GSM") != std::string_view::npos)
    identify(line.substr(1), arrival);
  return FrameResult::resync();
}

void GsmDriver::identify(std::string_view header, Stamp now) {
  health_.identity = header;
  const auto wanted = check_serial(settings_.serial, serial_of_gsm(header));
  if (!wanted && !another_) {
    emit(DeviceFault{now, wanted.error().message, wanted.error().remedy});
    set_state(LinkState::failed, wanted.error().text());
  }
  another_ = wanted ? std::nullopt : std::optional(wanted.error());
}

FrameResult GsmDriver::on_reading(const GsmReading& reading, Stamp arrival) {
  if (another_) return FrameResult::resync();
  if (reading.f_nT < settings_.min_nT || reading.f_nT > settings_.max_nT)
    return FrameResult::rejected(Reject::range);
  silence_.set(arrival.mono, settings_.silence_s);
  last_text_.clear();
  if (health_.state != LinkState::live) set_state(LinkState::live, "reading the total field");
  emit(ScalarReading{arrival, reading.f_nT, reading.quality.value_or(-1),
                     reading.quality.value_or(kBestQuality) == kBestQuality});
  return FrameResult::accepted();
}

}  // namespace mgtd::drivers::gsm
