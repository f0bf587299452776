// SPDX-License-Identifier: Apache-2.0
#include "daemon/app/recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "proto/version.h"

namespace mgtd::daemon::app {
namespace {

constexpr std::uint64_t kMegabyte = 1U << 20U;
constexpr double kRoomAgain = 1.1;  // of the reserve

RecordingStatus status_of(const store::Journal& journal) {
  RecordingStatus out;
  out.state = journal.recording() && !journal.trouble() ? "writing" : "stopped";
  if (journal.trouble()) out.why = journal.trouble()->text();
  out.bytes = journal.bytes_written();
  out.bytes_lost = journal.bytes_lost();
  out.stops = journal.stops();
  return out;
}

}  // namespace

LifeNote Recording::start(Stamp now, serve::StreamServer& stream) {
  const std::filesystem::path store(config_.store.dir);
  if (config_.store.journal) {
    store::JournalConfig journal;
    journal.directory = store / "runs";
    journal.name = fmt::format("raw-{:011}", now.wall.ns / 1'000'000'000);
    journal.header = {config_.rig_name, ""};
    journal.family = "raw-";
    journal.keep = {static_cast<std::uint64_t>(config_.store.journal_mb) * kMegabyte,
                    from_seconds(config_.store.journal_days * 86'400)};
    if (config_.store.journal_mb > 0)
      journal.rotate_bytes = std::min(journal.rotate_bytes, journal.keep.bytes / 4);
    journal_.emplace(std::move(journal), now.mono);
  }
  LifeNote life{software(), config_.text, 0, {}};
  if (config_.store.ring_mb > 0) start_disk_ring(life, now, stream);
  return life;
}

void Recording::start_disk_ring(LifeNote& life, Stamp now, serve::StreamServer& stream) {
  disk_ring_.emplace(
      store::DiskRingConfig{.directory = std::filesystem::path(config_.store.dir) / "stream",
                            .rig = config_.rig_name,
                            .rate_hz = config_.rate_hz,
                            .bytes = static_cast<std::uint64_t>(config_.store.ring_mb) * kMegabyte},
      now);
  stream.keep(*disk_ring_);
  life.first_seq = disk_ring_->first_seq();
  life.before = disk_ring_->between();
}

std::optional<LostNote> Recording::tick(Stamp now) {
  std::optional<LostNote> out;
  if (journal_) {
    journal_->tick(now.mono);
    if (const auto lost = watch(*journal_, "raw journal", now.mono)) out = LostNote{*lost};
  }
  if (disk_ring_) {
    disk_ring_->tick(now);
    static_cast<void>(watch(disk_ring_->journal(), "samples on disk", now.mono));
  }
  return out;
}

/// On a change only.
std::optional<std::uint64_t> Recording::watch(store::Journal& journal, const std::string& what, Instant now) {
  disk_sync_.look_after(journal);
  if (const auto error = journal.take_error()) log_.warn(what, error->text(), now);
  const auto lost = journal.take_resumed();
  if (lost) log_.warn(what, fmt::format("recorded again; {} bytes were not", *lost), now);
  return lost;
}

void Recording::guard_reserve() {
  std::error_code ec;
  const auto space = std::filesystem::space(config_.store.dir, ec);
  if (ec) return;
  const auto free_mb = static_cast<double>(space.available) / static_cast<double>(kMegabyte);
  const auto reserve_mb = static_cast<double>(config_.store.reserve_mb);
  for (store::Journal* const journal :
       {journal_ ? &*journal_ : nullptr, disk_ring_ ? &disk_ring_->journal() : nullptr}) {
    if (journal == nullptr) continue;
    if (free_mb < reserve_mb) {
      journal->hold({ErrorCode::io,
                     fmt::format("{:.0f} MB are free on the disk of {}, {:.0f} are kept for runs and "
                                 "calibrations; not recorded until there is more",
                                 free_mb, config_.store.dir, reserve_mb),
                     "make room, or lower reserve_mb, journal_mb or ring_mb in [store]"});
    } else if (free_mb >= kRoomAgain * reserve_mb) {
      journal->release();
    }
  }
}

void Recording::report(StatusReport& out) const {
  if (journal_) out.journal = status_of(*journal_);
  if (!disk_ring_) return;
  out.ring = status_of(disk_ring_->journal());
  out.oldest_seq = disk_ring_->oldest_seq();
}

}  // namespace mgtd::daemon::app
