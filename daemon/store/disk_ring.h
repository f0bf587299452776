// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "daemon/store/journal.h"
#include "proto/epoch.h"
#include "proto/ring_record.h"

/// The disk ring keeps the stream's samples and gaps, as far back as `bytes` reach, so that a client that
/// comes back gets what it missed, even after a restart. Written as the journal is (batches, synced aside,
/// stops when the disk refuses), read in pieces by RingReader.
///
/// Numbers of the stream go on from life to life: a new one begins after all that the last may have used, and
/// between() says what lies between. STATUS and RUN are not kept.
namespace mgtd::daemon::store {

struct DiskRingConfig {
  std::filesystem::path directory;
  std::string rig;
  double rate_hz{50};
  std::uint64_t bytes{256U << 20U};  ///< of all files together
  Duration write_every{std::chrono::milliseconds{500}};
  Duration sync_every{std::chrono::seconds{10}};
};

class RingReader;

class DiskRing {
 public:
  DiskRing(DiskRingConfig config, Stamp now);
  /// Says that the daemon ended in order.
  ~DiskRing();
  DiskRing(const DiskRing&) = delete;
  DiskRing& operator=(const DiskRing&) = delete;

  /// Where this life's numbers begin.
  [[nodiscard]] std::uint64_t first_seq() const { return first_seq_; }
  /// Epochs between the last line of the life before and first_seq(); nothing when none are.
  [[nodiscard]] const std::optional<Gap>& between() const { return between_; }

  /// A sample or a gap.
  void push(const RingRecord& record);
  void tick(Stamp now);

  /// The first number held; nothing when none is.
  [[nodiscard]] std::optional<std::uint64_t> oldest_seq() const;
  [[nodiscard]] RingReader read_from(std::uint64_t seq);
  [[nodiscard]] Journal& journal() { return journal_; }
  [[nodiscard]] const Journal& journal() const { return journal_; }

 private:
  friend class RingReader;
  struct Part {
    std::filesystem::path path;
    std::uint64_t first_seq{0};
  };
  struct Past {
    std::deque<Part> parts;  ///< the oldest first
    RingHistory history;
  };
  [[nodiscard]] static JournalConfig journal_config(const DiskRingConfig& config);
  [[nodiscard]] static Past learn(const std::filesystem::path& directory);
  void append(const RingRecord& record);
  void promise();
  void forget_removed();

  DiskRingConfig config_;
  Stamp now_;
  Past past_;
  std::uint64_t first_seq_{0};
  std::optional<Gap> between_;
  std::uint64_t next_seq_{0}, promised_{0}, removed_{0};
  std::string bytes_;  ///< reused
  Journal journal_;
};

/// Lines from one number on, a piece at a time. Outlived by its ring.
class RingReader {
 public:
  RingReader(DiskRing& ring, std::uint64_t seq);
  RingReader(RingReader&& other) noexcept;
  RingReader& operator=(RingReader&& other) noexcept;
  ~RingReader();

  /// Reads at most 64 kB and shows the samples and gaps in them, in order. False: there is no more.
  [[nodiscard]] bool read(const std::function<void(const RingRecord&)>& show);

 private:
  void open(const std::filesystem::path& path);
  [[nodiscard]] bool open_next();

  DiskRing* ring_;
  std::uint64_t seq_;
  std::filesystem::path path_;
  int fd_{-1};
  RawLogDecoder decoder_;
};

}  // namespace mgtd::daemon::store
