// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <boost/asio/io_context.hpp>
#include <optional>
#include <string>

#include "daemon/app/log.h"
#include "daemon/config/config.h"
#include "daemon/serve/stream_server.h"
#include "daemon/store/disk_ring.h"
#include "daemon/store/disk_sync.h"
#include "daemon/store/journal.h"
#include "proto/journal_note.h"
#include "proto/status_report.h"

/// Recording writes the journal of raw bytes and the stream's samples to disk all the time, as far as the
/// configuration wants them. It stops where the disk's reserve is touched.
namespace mgtd::daemon::app {

class Recording {
 public:
  /// All outlive this.
  Recording(boost::asio::io_context& io, const config::Config& config, QuietLog& log)
      : config_(config), log_(log), disk_sync_(io) {}

  /// Opens both. What is returned belongs first into the journal. The stream keeps its samples from here on.
  [[nodiscard]] LifeNote start(Stamp now, serve::StreamServer& stream);
  void append(const RawRecord& record) {
    if (journal_) journal_->append(record);
  }
  /// Every 20-50 ms. What was lost before the journal went on, to be noted in it.
  [[nodiscard]] std::optional<LostNote> tick(Stamp now);
  /// Every second: holds both while less than the reserve is free on the disk.
  void guard_reserve();
  /// How both are doing.
  void report(StatusReport& out) const;

 private:
  void start_disk_ring(LifeNote& life, Stamp now, serve::StreamServer& stream);
  /// Bytes that were lost before it went on.
  [[nodiscard]] std::optional<std::uint64_t> watch(store::Journal& journal, const std::string& what,
                                                   Instant now);

  const config::Config& config_;
  QuietLog& log_;
  std::optional<store::DiskRing> disk_ring_;
  std::optional<store::Journal> journal_;
  store::DiskSync disk_sync_;
};

}  // namespace mgtd::daemon::app
