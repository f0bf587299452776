// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "daemon/store/rotated_files.h"
#include "proto/error.h"
#include "proto/raw_log.h"
#include "proto/time.h"

/// A Journal appends records to files of bounded size: NAME.000000.raw, NAME.000001.raw, ...
///
/// Records are gathered in memory and written every write_every (and when buffer_bytes are full); a sync is
/// due at sync_every and for every file that is full. So a kill costs write_every, and a power cut sync_every
/// and what the disk needs. The sync itself is left to whoever takes take_syncs(), so that a slow disk delays
/// nobody.
///
/// When the disk refuses, recording stops, says so once, and everything else goes on; a new file is tried
/// every retry_every, and recording goes on, which is said, when it has taken the first bytes. Before a new
/// file the oldest go by the `keep` rule.
namespace mgtd::daemon::store {

struct JournalConfig {
  std::filesystem::path directory;
  std::string name;  ///< stem of the files, e.g. the run id
  RawLogHeader header;
  std::string what{"raw bytes"};  ///< for the operator
  std::string suffix{".raw"};
  std::string family;  ///< the `keep` rule counts every file whose name begins so; empty: of this name
  KeepRule keep;
  std::uint64_t rotate_bytes{64U << 20U};
  std::size_t buffer_bytes{1U << 16U};
  Duration rotate_after{std::chrono::hours{24}};
  Duration write_every{std::chrono::milliseconds{500}};
  Duration sync_every{std::chrono::seconds{10}};
  Duration retry_every{std::chrono::seconds{10}};
};

class Journal {
 public:
  /// May find that it cannot write: see recording().
  Journal(JournalConfig config, Instant now);
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;
  /// Writes and syncs what is left.
  ~Journal();

  /// Never fails: what cannot be written is counted as lost.
  void append(const RawRecord& record);
  /// Writes, and tries again, when it is time. Call every 20-50 ms.
  void tick(Instant now);
  /// Stops recording, for the reason given, until release().
  void hold(Error why);
  void release();

  /// Descriptors to be synced and closed by the caller, who then says how it went.
  [[nodiscard]] std::vector<int> take_syncs();
  void synced(int os_error);

  [[nodiscard]] bool recording() const { return file_.fd >= 0; }
  /// Why it does not record; nothing once it does.
  [[nodiscard]] const std::optional<Error>& trouble() const { return trouble_; }
  /// Trouble that was not told yet; given once.
  [[nodiscard]] std::optional<Error> take_error();
  /// Bytes lost before recording went on; given once, when it does.
  [[nodiscard]] std::optional<std::uint64_t> take_resumed();
  [[nodiscard]] std::uint64_t bytes_written() const { return written_; }
  [[nodiscard]] std::uint64_t bytes_lost() const { return lost_; }
  [[nodiscard]] std::uint64_t stops() const { return stops_; }
  [[nodiscard]] std::uint64_t files_removed() const { return removed_; }
  [[nodiscard]] const std::filesystem::path& file() const { return file_.path; }

 private:
  /// The file that is written, or was last.
  struct File {
    std::filesystem::path path;
    int fd{-1};
    std::uint64_t header{0}, bytes{0};  ///< bytes: with those of the header
    Instant since{};
    bool unsynced{false};
  };

  void start_file();
  void flush();
  void rotate();
  void stop(Error why);
  [[nodiscard]] Error refused(int os_error, const char* doing) const;

  JournalConfig config_;
  File file_;
  RawLogEncoder encoder_;
  std::string buffer_;
  std::uint64_t written_{0}, lost_{0}, lost_reported_{0}, stops_{0}, removed_{0};
  Instant now_, last_write_, last_sync_, last_try_;
  bool held_{false}, resumed_{false};
  std::vector<int> syncs_;  ///< of files that are full
  std::optional<Error> trouble_, unreported_;
};

}  // namespace mgtd::daemon::store
