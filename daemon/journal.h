// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "proto/error.h"
#include "proto/raw_log.h"
#include "proto/time.h"

/// Raw bytes to disk, append-only, in files of bounded size: NAME.000.raw, NAME.001.raw, ...
///
/// Records are gathered in memory and written every write_every (and when buffer_bytes are full); the file is
/// synced at sync_every and when it is closed, so that a power cut costs that much at most and a kill costs
/// write_every. When the disk refuses, recording stops, says so once, and everything else goes on; `retry`
/// starts a new file.
namespace mgtd::daemon {

struct JournalConfig {
  std::filesystem::path directory;
  std::string name;  ///< stem of the files, e.g. the run id
  RawLogHeader header;
  std::uint64_t rotate_bytes{64U << 20U};
  std::size_t buffer_bytes{1U << 16U};
  Duration write_every{std::chrono::milliseconds{500}};
  Duration sync_every{std::chrono::seconds{10}};
};

class Journal {
 public:
  [[nodiscard]] static Result<Journal> open(JournalConfig config, Instant now);
  Journal(Journal&& other) noexcept;
  Journal& operator=(Journal&& other) noexcept;
  ~Journal();

  /// Never fails: what cannot be written is counted as lost.
  void append(const RawRecord& record);
  /// Writes and syncs when it is time. Call every 20-50 ms.
  void tick(Instant now);
  /// After the operator made room: a new file.
  [[nodiscard]] Result<void> retry(Instant now);

  [[nodiscard]] bool recording() const { return fd_ >= 0; }
  /// Why recording stopped; given once.
  [[nodiscard]] std::optional<Error> take_error();
  [[nodiscard]] std::uint64_t bytes_written() const { return written_; }
  [[nodiscard]] std::uint64_t bytes_lost() const { return lost_; }
  [[nodiscard]] const std::filesystem::path& file() const { return file_; }

 private:
  explicit Journal(JournalConfig config) : config_(std::move(config)) {}
  [[nodiscard]] Result<void> start_file();
  void flush();
  void close();
  void stop(int os_error, const char* doing);

  JournalConfig config_;
  std::filesystem::path file_;
  int fd_{-1};
  int number_{0};
  std::string buffer_;
  std::uint64_t in_file_{0}, written_{0}, lost_{0};
  Instant last_write_{}, last_sync_{};
  bool unsynced_{false};
  std::optional<Error> error_;
};

}  // namespace mgtd::daemon
