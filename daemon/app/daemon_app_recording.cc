// SPDX-License-Identifier: Apache-2.0
// What the rig records all the time: raw bytes and the stream's samples.
#include <fmt/format.h>

#include <system_error>

#include "daemon/app/daemon_app.h"

namespace mgtd::daemon {
namespace {

constexpr std::uint64_t kMegabyte = 1U << 20U;
constexpr double kRoomAgain = 1.1;  // of the reserve

}  // namespace

void DaemonApp::start_recording() {
  const std::filesystem::path store(config_.store_dir);
  if (config_.journal) {
    JournalConfig journal;
    journal.directory = store / "runs";
    journal.name = fmt::format("raw-{:011}", started_.wall.ns / 1'000'000'000);
    journal.header = {config_.rig_name, ""};
    journal.family = "raw-";
    journal.keep = {static_cast<std::uint64_t>(config_.journal_mb) * kMegabyte,
                    from_seconds(config_.journal_days * 86'400)};
    if (config_.journal_mb > 0) journal.rotate_bytes = std::min(journal.rotate_bytes, journal.keep.bytes / 4);
    journal_.emplace(std::move(journal), started_.mono);
  }
  LifeNote life{"mgtd " MGTD_VERSION, config_.text, 0, {}};
  if (config_.ring_mb > 0) start_disk_ring(life);
  note(life, started_);
}

void DaemonApp::start_disk_ring(LifeNote& life) {
  disk_ring_.emplace(DiskRingConfig{.directory = std::filesystem::path(config_.store_dir) / "stream",
                                    .rig = config_.rig_name,
                                    .rate_hz = config_.rate_hz,
                                    .bytes = static_cast<std::uint64_t>(config_.ring_mb) * kMegabyte},
                     started_);
  stream_.keep(*disk_ring_);
  SamplerConfig sampler = sampler_config(config_);
  sampler.first_seq = life.first_seq = disk_ring_->first_seq();
  life.before = disk_ring_->between();
  pipeline_ = LivePipeline(sampler, config_.baseline_m, inputs_of(config_));
}

void DaemonApp::on_raw(const RawRecord& record) {
  settle_calibrating(record.at);
  if (journal_) journal_->append(record);
}

void DaemonApp::note(const JournalNote& note, Stamp at) {
  if (!journal_) return;
  const std::string text = encode(note);
  journal_->append({.device = kRawDaemon, .direction = RawDirection::note, .at = at, .bytes = text});
}

/// Between records only, so that a replay does it at the same sample.
void DaemonApp::settle_calibrating(Stamp at) {
  const bool calibrating = run_.active() || (magnet_ && !magnet_->ended());
  if (calibrating == calibrating_) return;
  calibrating_ = calibrating;
  pipeline_.set_calibrating(calibrating_);
  note(CalibratingNote{calibrating_}, at);
}

void DaemonApp::record(Stamp now) {
  if (journal_) {
    journal_->tick(now.mono);
    watch_recording(*journal_, "raw journal", now.mono);
  }
  if (disk_ring_) {
    disk_ring_->tick(now);
    watch_recording(disk_ring_->journal(), "samples on disk", now.mono);
  }
}

/// On a change only.
void DaemonApp::watch_recording(Journal& journal, const std::string& what, Instant now) {
  disk_sync_.look_after(journal);
  if (const auto error = journal.take_error()) quiet_.warn(what, error->text(), now);
  const auto lost = journal.take_resumed();
  if (lost && journal_ && &journal == &*journal_) note(LostNote{*lost}, clock_.now());
  if (lost) quiet_.warn(what, fmt::format("recorded again; {} bytes were not", *lost), now);
}

void DaemonApp::guard_reserve() {
  std::error_code ec;
  const auto space = std::filesystem::space(config_.store_dir, ec);
  if (ec) return;
  const auto free_mb = static_cast<double>(space.available) / static_cast<double>(kMegabyte);
  const auto reserve_mb = static_cast<double>(config_.reserve_mb);
  for (Journal* const journal :
       {journal_ ? &*journal_ : nullptr, disk_ring_ ? &disk_ring_->journal() : nullptr}) {
    if (journal == nullptr) continue;
    if (free_mb < reserve_mb) {
      journal->hold({ErrorCode::io,
                     fmt::format("{:.0f} MB are free on the disk of {}, {:.0f} are kept for runs and "
                                 "calibrations; not recorded until there is more",
                                 free_mb, config_.store_dir, reserve_mb),
                     "make room, or lower reserve_mb, journal_mb or ring_mb in [store]"});
    } else if (free_mb >= kRoomAgain * reserve_mb) {
      journal->release();
    }
  }
}

}  // namespace mgtd::daemon
