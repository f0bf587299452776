// SPDX-License-Identifier: Apache-2.0
#include "drivers/obsdaq_driver.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "drivers/identity.h"

namespace mgtd::drivers::obsdaq {
namespace {

constexpr std::size_t kLongestObsdaqLine = 128;
constexpr double kWait_s = 2.0;  ///< before a device that did not answer is asked again
constexpr double kObsdaqRetry_s = 10.0;
constexpr double kSilent_s = 1.0;
constexpr int kSilentTicks = 50;

std::string without_cr(std::string text) {
  std::erase(text, '\r');
  return text.starts_with('|') ? "||||" : text;
}

/// A line that lost its ending holds the start of the next one too; a reply is no sample.
std::uint64_t samples_lost(std::string_view line) {
  if (line.starts_with('!') || line.starts_with('?')) return 0;
  return static_cast<std::uint64_t>(std::max<std::ptrdiff_t>(1, std::count(line.begin(), line.end(), '*')));
}

bool is_obsdaq(std::string identity) {
  std::transform(identity.begin(), identity.end(), identity.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return identity.find("obsdaq") != std::string::npos;
}

}  // namespace

ObsdaqDriver::ObsdaqDriver(int slot, ObsdaqSettings settings)
    : LineDevice({Ending::cr, kLongestObsdaqLine, settings.baud}),
      slot_(slot),
      settings_(std::move(settings)) {}

std::unique_ptr<Device> ObsdaqDriver::make(int slot, Settings& settings) {
  return std::make_unique<ObsdaqDriver>(slot, read_obsdaq_settings(settings, slot));
}

void ObsdaqDriver::on_open(Stamp now) {
  LineDevice::on_open(now);
  start(Patience::brisk, now);
}

void ObsdaqDriver::on_close(Stamp now) {
  LineDevice::on_close(now);
  phase_ = Phase::closed;
}

void ObsdaqDriver::on_shutdown(Stamp /*now*/) {
  if (phase_ == Phase::streaming && !settings_.palmacq) send(stop(settings_.address));
}

void ObsdaqDriver::start(Patience patience, Stamp now) {
  phase_ = Phase::starting;
  patience_ = patience;
  identity_heard_.clear();
  serial_.clear();
  dialogue_ = start_up(settings_, patience);
  dialogue_.start(now.mono);
  send(dialogue_.take_send());
}

void ObsdaqDriver::on_tick(Stamp now) {
  LineDevice::on_tick(now);
  if (phase_ == Phase::starting) {
    dialogue_.on_tick(now.mono, health_.bytes_in);
    pump(now);
  } else if (phase_ == Phase::streaming) {
    watch_silence(now);
    if (phase_ == Phase::streaming) watch_rate(now);
  } else if (phase_ == Phase::waiting && retry_.passed(now.mono)) {
    start(Patience::patient, now);
  }
}

void ObsdaqDriver::pump(Stamp now) {
  send(dialogue_.take_send());
  if (dialogue_.identity() != identity_heard_ && !identified(now)) return;
  if (dialogue_.outcome() == Dialogue::Outcome::done) {
    go_live(now);
  } else if (dialogue_.outcome() == Dialogue::Outcome::running) {
    return;
  } else if (patience_ == Patience::brisk && dialogue_.outcome() != Dialogue::Outcome::never_silent) {
    start(Patience::patient, now);
  } else {
    give_up(now);
  }
}

/// Its name, then its serial number, as each is told. False: it is not the one that is wanted.
bool ObsdaqDriver::identified(Stamp now) {
  const bool names_itself = identity_heard_.empty();
  identity_heard_ = dialogue_.identity();
  const std::string said = identity_heard_.substr(3);
  if (names_itself) {
    model_ = said;
    if (is_obsdaq(said)) return true;
    refuse(now, fmt::format("wrong device on the port: it calls itself '{}', not an ObsDAQ", said),
           "check which device is on this port");
    return false;
  }
  return tells_serial(said, now);
}

/// Asked for twice, since no checksum guards the answer: a number that was damaged on the line is another one
/// the second time, and the conversation begins again.
bool ObsdaqDriver::tells_serial(std::string_view said, Stamp now) {
  const std::string serial = serial_after_sn(said);
  if (!serial_.empty() && serial != serial_) {
    start(Patience::patient, now);
    return false;
  }
  serial_ = serial;
  if (auto wanted = check_serial(settings_.serial, serial); !wanted) {
    refuse(now, wanted.error().message, wanted.error().remedy);
    return false;
  }
  identify(now, fmt::format("{}, serial {}", model_, serial));
  return true;
}

void ObsdaqDriver::identify(Stamp now, std::string as) {
  if (health_.identity == as) return;
  health_.identity = std::move(as);
  emit(DeviceNote{now, "identified as " + health_.identity});
}

void ObsdaqDriver::go_live(Stamp now) {
  phase_ = Phase::streaming;
  if (serial_.empty()) identify(now, model_);  // its serial number was not told
  seq_ = 0;
  any_good_line_ = without_time_ = false;
  bytes_at_good_line_ = health_.bytes_in;
  last_fault_.clear();
  silence_.set(now.mono, silence_s(), kSilentTicks);
  rate_.restart();
  // A digitiser without the time-stamper that should be there answers every question and yet is of no use.
  if (hint_at_palmacq().empty()) show_live();
}

void ObsdaqDriver::show_live() {
  if (health_.state == LinkState::live) return;
  set_state(LinkState::live,
            fmt::format("{} at {:.2f} Hz, +-{} V{}", settings_.sensor, settings_.timing.rate_hz(),
                        settings_.range.volts, settings_.palmacq ? ", time-stamped by PalmAcq" : ""));
}

std::string ObsdaqDriver::hint_at_palmacq() const {
  if (!settings_.palmacq || dialogue_.answered(connect_through().command)) return {};
  return "no time-stamper answers: set palmacq = false?";
}

void ObsdaqDriver::give_up(Stamp now) {
  const std::string asked = without_cr(dialogue_.step().send), hint = hint_at_palmacq();
  switch (dialogue_.outcome()) {
    case Dialogue::Outcome::no_answer:
      phase_ = Phase::waiting;
      retry_.set(now.mono, kWait_s);
      set_state(LinkState::silent,
                fmt::format("no answer to '{}' in {} attempts at {} Bd; check power, cable, baud and address "
                            "{}{}",
                            asked, Pace().attempts, settings_.baud, settings_.address,
                            !settings_.palmacq ? ", and palmacq = true if a PalmAcq stands between"
                            : hint.empty()     ? ""
                                               : "; " + hint));
      return;
    case Dialogue::Outcome::never_silent:
      refuse(now,
             fmt::format("{}bytes keep coming {} s after '{}'",
                         hint.empty() ? "wrong device on the port? " : "", Dialogue::kDrainLimit_s, asked),
             hint.empty() ? "check which device is on this port and its baud" : hint);
      return;
    default:
      refuse(now,
             fmt::format("wrong device on the port? '{}' was answered by '{}' instead of '{}'", asked,
                         dialogue_.heard(), dialogue_.step().reply),
             "check which device is on this port, its address and its firmware");
  }
}

void ObsdaqDriver::refuse(Stamp now, std::string what, std::string remedy) {
  phase_ = Phase::waiting;
  retry_.set(now.mono, kObsdaqRetry_s);
  set_state(LinkState::failed, what + "; " + remedy);
  if (std::exchange(last_fault_, what) != what) emit(DeviceFault{now, std::move(what), std::move(remedy)});
}

/// Shorter than any device needs to come up again after its power failed: what was silent for so long is told
/// its settings anew, range and rate, and not believed to have kept them.
double ObsdaqDriver::silence_s() const { return std::max(kSilent_s, 10.0 / settings_.timing.rate_hz()); }

/// The host's settings are those that count.
void ObsdaqDriver::watch_rate(Stamp now) {
  const double wanted_hz = settings_.timing.rate_hz();
  const auto found_hz = rate_.wrong_hz(wanted_hz, now.mono);
  if (!found_hz) return;
  set_state(LinkState::silent,
            fmt::format("it sends {:.2f} readings a second instead of {:.2f}; telling it its settings again",
                        *found_hz, wanted_hz));
  emit(DeviceNote{now, health_.detail});
  start(Patience::patient, now);
}

void ObsdaqDriver::watch_silence(Stamp now) {
  if (!silence_.passed(now.mono)) return;
  if (const std::string hint = hint_at_palmacq(); without_time_ && !any_good_line_ && !hint.empty())
    return refuse(now, "lines come without the time of a PalmAcq", hint);
  const bool mute = health_.bytes_in == bytes_at_good_line_;
  set_state(LinkState::silent,
            fmt::format("{} for {:.1f} s; starting the digitiser again",
                        mute ? "nothing came" : "bytes came but no valid line (check baud and cabling)",
                        silence_s()));
  emit(DeviceNote{now, health_.detail});
  start(any_good_line_ ? Patience::brisk : Patience::patient, now);
}

FrameResult ObsdaqDriver::on_line(std::string_view line, Stamp arrival) {
  if (phase_ == Phase::streaming) return on_stream_line(line, arrival);
  if (phase_ != Phase::starting || line.empty()) return FrameResult::resync();
  if (line.starts_with('*') || line.starts_with(":R,")) {  // still streaming from before, or already again
    return FrameResult::resync();
  }
  dialogue_.on_line(line, arrival.mono);
  pump(arrival);
  return FrameResult::accepted();
}

void ObsdaqDriver::on_damaged_line(std::string_view text) {
  if (phase_ == Phase::streaming && any_good_line_) seq_ += samples_lost(text);
}

FrameResult ObsdaqDriver::on_stream_line(std::string_view line, Stamp arrival) {
  const auto sample = parse_data_line(line);
  if (!sample || sample->time_stamped != settings_.palmacq) {
    without_time_ = without_time_ || (sample && !sample->time_stamped);
    if (!any_good_line_) return FrameResult::resync();
    seq_ += samples_lost(line);
    return FrameResult::rejected(sample ? Reject::framing : sample.error());
  }
  if (!std::exchange(any_good_line_, true)) show_live();
  bytes_at_good_line_ = health_.bytes_in;
  silence_.set(arrival.mono, silence_s(), kSilentTicks);
  emit_sample(*sample, arrival);
  return FrameResult::accepted();
}

void ObsdaqDriver::emit_sample(const Sample& sample, Stamp arrival) {
  FieldReading reading;
  reading.slot = slot_;
  reading.seq = seq_++;
  rate_.heard(reading.seq, arrival.mono);
  reading.arrival = arrival;
  reading.device_time_s = sample.device_time_s;
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    reading.y_nT[axis] = volts(sample.counts[i], settings_.range.volts) * settings_.scale_nT_per_V[axis] +
                         settings_.offset_nT[axis];
  }
  if (sample.saturated()) reading.flags |= Flag::saturated;
  emit(reading);
  if (sample.time_stamped && !sample.device_time_s && !std::exchange(impossible_date_noted_, true))
    emit(DeviceNote{arrival, "the PalmAcq sends a date that does not exist: samples go without device time"});
  if (!sample.supplement) return;
  emit(TemperatureReading{slot_, arrival, std::nullopt, sample.supplement->electronics_degC,
                          sample.supplement->supply_V});
  std::array<std::optional<double>, kInputs> inputs_V;
  for (std::size_t i = 0; i < kInputs; ++i) {
    const double volts = sample.supplement->aux_V.at(i);
    if (std::abs(volts) < kInputEnd_V) inputs_V.at(i) = volts;
  }
  report_inputs(settings_.inputs, inputs_V, arrival, [this](DeviceEvent event) { emit(std::move(event)); });
}

}  // namespace mgtd::drivers::obsdaq
