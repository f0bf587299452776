// SPDX-License-Identifier: Apache-2.0
#include "daemon/serve/console/metrics.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "proto/run_status.h"

namespace mgtd::daemon::serve::console {
namespace {

using Labels = std::vector<std::pair<std::string_view, std::string_view>>;

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\' || c == '"') out += '\\';
    out += c == '\n' ? ' ' : c;
  }
  return out;
}

class Page {
 public:
  /// Begins a metric; its values follow.
  void metric(std::string_view name, std::string_view type, std::string_view help) {
    name_ = name;
    fmt::format_to(std::back_inserter(text_), "# HELP {0} {1}\n# TYPE {0} {2}\n", name, help, type);
  }
  void value(double value, const Labels& labels = {}) {
    std::string list;
    for (const auto& [key, label] : labels)
      list += fmt::format("{}{}=\"{}\"", list.empty() ? "" : ",", key, escaped(label));
    fmt::format_to(std::back_inserter(text_), "{}{} {}\n", name_, list.empty() ? "" : "{" + list + "}",
                   value);
  }
  void whole(std::string_view name, std::string_view type, std::string_view help, std::uint64_t count) {
    metric(name, type, help);
    value(static_cast<double>(count));
  }
  [[nodiscard]] std::string text() && { return std::move(text_); }

 private:
  std::string text_, name_;
};

void devices(const StatusReport& report, Page& page) {
  page.metric("mgtd_device_live", "gauge", "1 while the device measures.");
  for (const DeviceStatus& d : report.devices)
    page.value(d.health.state == LinkState::live ? 1 : 0, {{"device", d.name}});
  page.metric("mgtd_device_frames_total", "counter", "Good frames of the device.");
  for (const DeviceStatus& d : report.devices)
    page.value(static_cast<double>(d.health.frames), {{"device", d.name}});
  page.metric("mgtd_device_frame_rate_hertz", "gauge", "Good frames a second of late.");
  for (const DeviceStatus& d : report.devices)
    if (d.rate_hz) page.value(*d.rate_hz, {{"device", d.name}});
  page.metric("mgtd_device_state_seconds", "gauge", "For how long the device is in its state.");
  for (const DeviceStatus& d : report.devices)
    if (d.health.state_since)
      page.value(to_seconds(report.at.mono - *d.health.state_since), {{"device", d.name}});
  page.metric("mgtd_device_rejected_total", "counter", "Frames that were rejected, by reason.");
  for (const DeviceStatus& d : report.devices) {
    for (std::size_t i = 0; i < kRejects; ++i)
      if (d.health.rejected[i] > 0)
        page.value(static_cast<double>(d.health.rejected[i]),
                   {{"device", d.name}, {"reason", kRejectNames[i]}});
  }
  page.metric("mgtd_device_closes_total", "counter", "How often the port of the device was lost or closed.");
  for (const DeviceStatus& d : report.devices)
    page.value(static_cast<double>(d.health.closes), {{"device", d.name}});
}

void inputs(const StatusReport& report, Page& page) {
  page.metric("mgtd_input", "gauge", "Auxiliary inputs and thermometers, in the unit of the label.");
  for (const InputStatus& input : report.inputs)
    if (input.value && std::isfinite(*input.value))
      page.value(*input.value, {{"name", input.name}, {"unit", input.unit}});
}

bool is_doubted(std::string_view state) {
  constexpr std::array<std::string_view, 4> kDoubts{"suspect", "identity", "exchanged", "turned"};
  return std::find(kDoubts.begin(), kDoubts.end(), state) != kDoubts.end();
}

}  // namespace

std::string metrics(const StatusReport& report, std::uint64_t console_refused) {
  Page page;
  page.metric("mgtd_info", "gauge", "Rig and version.");
  page.value(1, {{"rig", report.rig}, {"software", report.software}});
  page.metric("mgtd_uptime_seconds", "gauge", "Since the daemon started.");
  page.value(report.uptime_s);
  page.whole("mgtd_epochs_total", "counter", "Epochs that were measured.", report.sampler.epochs);
  page.whole("mgtd_gap_epochs_total", "counter", "Epochs that were not measured.", report.sampler.gaps);
  if (report.sampler.rate_hz) {
    page.metric("mgtd_epoch_rate_hertz", "gauge", "Epochs a second.");
    page.value(*report.sampler.rate_hz);
  }
  if (report.sampler.skew_bound_s) {
    page.metric("mgtd_skew_bound_seconds", "gauge", "No two readings of an epoch are further apart in time.");
    page.value(*report.sampler.skew_bound_s);
  }
  devices(report, page);
  inputs(report, page);
  page.metric("mgtd_calibration_active", "gauge", "1 while a calibration is active.");
  page.value(report.calibration ? 1 : 0, {{"id", report.calibration.value_or("")}});
  if (report.calibration_use.age_s) {
    page.metric("mgtd_calibration_age_seconds", "gauge", "Since the run of the active calibration began.");
    page.value(*report.calibration_use.age_s);
  }
  page.metric("mgtd_calibration_doubted", "gauge", "1 while the stream contradicts the calibration.");
  page.value(is_doubted(report.criticism.state) ? 1 : 0);
  page.metric("mgtd_run_active", "gauge", "1 while a calibration run is going on.");
  page.value(is_active(report.run.state) ? 1 : 0);
  page.metric("mgtd_run_poses_done", "gauge", "Poses of the run that are on disk.");
  page.value(report.run.pose);
  page.whole("mgtd_stream_clients", "gauge", "Clients of the stream.", report.stream.clients);
  page.whole("mgtd_stream_dropped_total", "counter", "Clients that were disconnected.",
             report.stream.dropped());
  page.whole("mgtd_console_refused_total", "counter",
             "Control and computations that the console refused: wrong token, or from elsewhere.",
             console_refused);
  page.whole("mgtd_journal_bytes_total", "counter", "Written to the raw journal.", report.journal.bytes);
  page.whole("mgtd_journal_lost_bytes_total", "counter", "Not written because the disk refused.",
             report.journal.bytes_lost);
  if (report.disk_free_bytes)
    page.whole("mgtd_disk_free_bytes", "gauge", "Free on the disk of the runs.", *report.disk_free_bytes);
  return std::move(page).text();
}

}  // namespace mgtd::daemon::serve::console
