// SPDX-License-Identifier: Apache-2.0
// What the rig says of itself.
#include <system_error>

#include "daemon/rig.h"

namespace mgtd::daemon {

StatusReport Rig::report() const {
  const Stamp now = clock_.now();
  StatusReport out;
  out.at = now;
  out.uptime_s = to_seconds(now.mono - started_.mono) / config_.speed_up;
  out.software = "mgtd " MGTD_VERSION;
  out.rig = config_.rig_name;
  out.speed_up = config_.speed_up;
  out.calibration = store_.active_id();
  if (const auto& used = live_.calibration()) {
    out.calibration_use.forced = !used->accepted_by_checks;
    for (const auto& [effect, lacks] : live_.left_out())
      out.calibration_use.left_out.push_back({effect, lacks});
  }
  const calib::LiveVerdict& verdict = criticism_.verdict();
  out.criticism = {std::string(calib::to_string(verdict.state)), verdict.measured, verdict.limit,
                   verdict.remedy};
  out.devices = instruments_.status();
  const SamplerHealth sampler = sampler_.health();
  out.sampler = {
      .epochs = sampler.epochs, .gaps = sampler.gaps, .rate_hz = rate_hz_, .skew_bound_s = last_skew_s_};
  out.stream = stream_.stats();
  out.control = control_.stats();
  out.journal.state = journal_ ? (journal_->recording() ? "writing" : "stopped: the disk refused") : "off";
  out.journal.bytes = journal_ ? journal_->bytes_written() : 0;
  std::error_code ec;
  if (const auto space = std::filesystem::space(config_.store_dir, ec); !ec)
    out.disk_free_bytes = space.available;
  out.run = run_.status(now.mono);
  return out;
}

}  // namespace mgtd::daemon
