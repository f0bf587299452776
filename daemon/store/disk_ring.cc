// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/disk_ring.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace mgtd::daemon::store {
namespace {

constexpr const char* kStem = "stream";
constexpr const char* kSuffix = ".ring";
constexpr std::uint64_t kParts = 16;  // files that share the space: the oldest goes as a whole
constexpr double kPromisedSyncs = 3;  // a promise reaches so many periods of syncing ahead
constexpr std::size_t kPiece = 65'536;
constexpr double kFaster = 1.1;  // than the rate that the configuration says

/// What a file holds, record by record, until `use` says no.
template <class Use>
void scan(const std::filesystem::path& path, Use use) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return;
  RawLogDecoder decoder;
  std::string piece(kPiece, '\0');
  for (bool more = true; more;) {
    const ssize_t n = ::read(fd, piece.data(), piece.size());
    if (n <= 0) break;
    decoder.feed(std::string_view(piece).substr(0, static_cast<std::size_t>(n)));
    while (more) {
      const auto record = decoder.next();
      if (!record) break;
      if (const auto kept = ring_record(*record)) more = use(*kept);
    }
    more = more && decoder.state() != RawLogDecoder::State::damaged;
  }
  ::close(fd);
}

bool is_line(const RingRecord& record) {
  return record.kind == RingRecord::Kind::sample || record.kind == RingRecord::Kind::gap;
}

}  // namespace

JournalConfig DiskRing::journal_config(const DiskRingConfig& config) {
  JournalConfig out;
  out.directory = config.directory;
  out.name = kStem;
  out.header = {config.rig, kStem};
  out.what = "the stream's samples";
  out.suffix = kSuffix;
  out.keep.bytes = config.bytes;
  out.rotate_bytes = config.bytes / kParts;
  out.rotate_after = std::chrono::hours{24 * 365};
  out.write_every = config.write_every;
  out.sync_every = config.sync_every;
  return out;
}

// Before the journal opens, since that removes what is too much.
DiskRing::DiskRing(DiskRingConfig config, Stamp now)
    : config_(std::move(config)),
      now_(now),
      past_(learn(config_.directory)),
      journal_(journal_config(config_), now.mono) {
  const RingHistory& history = past_.history;
  first_seq_ = next_seq_ = history.next_seq(now.wall, config_.rate_hz);
  if (first_seq_ > history.end_seq() && !history.empty()) {
    between_ = Gap{history.end_seq(), first_seq_ - 1, now,
                   history.closed() ? "the daemon was stopped"
                                    : "the daemon ended without a word (killed, crashed or power lost)"};
  }
  promise();
}

/// What earlier lives left. Their last words are in the newest file that has any.
DiskRing::Past DiskRing::learn(const std::filesystem::path& directory) {
  Past past;
  const auto files = rotated_files(directory, std::string(kStem) + ".", kSuffix);
  for (const RotatedFile& file : files) {
    scan(file.path, [&](const RingRecord& record) {
      if (is_line(record)) past.parts.push_back({file.path, record.from_seq});
      return !is_line(record);
    });
  }
  for (auto file = files.rbegin(); file != files.rend() && past.history.empty(); ++file) {
    scan(file->path, [&](const RingRecord& record) {
      past.history.add(record);
      return true;
    });
  }
  return past;
}

DiskRing::~DiskRing() { append({RingRecord::Kind::closed, next_seq_, next_seq_, now_, {}}); }

void DiskRing::append(const RingRecord& record) {
  bytes_.clear();
  encode_ring_bytes(record, bytes_);
  journal_.append(frame(record, bytes_));
}

void DiskRing::promise() {
  const double ahead = kPromisedSyncs * to_seconds(config_.sync_every) * config_.rate_hz * kFaster;
  promised_ = next_seq_ + static_cast<std::uint64_t>(std::ceil(ahead));
  append({RingRecord::Kind::promise, promised_, promised_, now_, {}});
}

void DiskRing::push(const RingRecord& record) {
  if (journal_.recording() && (past_.parts.empty() || past_.parts.back().path != journal_.file())) {
    past_.parts.push_back({journal_.file(), record.from_seq});
    promise();  // the next life looks for it in the newest file
  }
  append(record);
  next_seq_ = record.to_seq + 1;
  const double half = kPromisedSyncs / 2 * to_seconds(config_.sync_every) * config_.rate_hz;
  if (static_cast<double>(next_seq_) + half > static_cast<double>(promised_)) promise();
}

void DiskRing::tick(Stamp now) {
  now_ = now;
  journal_.tick(now.mono);
  if (std::exchange(removed_, journal_.files_removed()) != journal_.files_removed()) forget_removed();
}

void DiskRing::forget_removed() {
  std::error_code error;
  while (!past_.parts.empty() && !std::filesystem::exists(past_.parts.front().path, error))
    past_.parts.pop_front();
}

std::optional<std::uint64_t> DiskRing::oldest_seq() const {
  return past_.parts.empty() ? std::nullopt : std::optional(past_.parts.front().first_seq);
}

RingReader DiskRing::read_from(std::uint64_t seq) { return RingReader(*this, seq); }

RingReader::RingReader(DiskRing& ring, std::uint64_t seq) : ring_(&ring), seq_(seq) {
  const auto after = std::find_if(ring.past_.parts.begin(), ring.past_.parts.end(),
                                  [seq](const DiskRing::Part& part) { return part.first_seq > seq; });
  if (after != ring.past_.parts.begin()) open(std::prev(after)->path);
  if (fd_ < 0 && after != ring.past_.parts.end()) open(after->path);
}

RingReader::RingReader(RingReader&& other) noexcept
    : ring_(other.ring_),
      seq_(other.seq_),
      path_(std::move(other.path_)),
      fd_(std::exchange(other.fd_, -1)),
      decoder_(std::move(other.decoder_)) {}

RingReader& RingReader::operator=(RingReader&& other) noexcept {
  std::swap(ring_, other.ring_);
  std::swap(seq_, other.seq_);
  std::swap(path_, other.path_);
  std::swap(fd_, other.fd_);
  std::swap(decoder_, other.decoder_);
  return *this;
}

RingReader::~RingReader() {
  if (fd_ >= 0) ::close(fd_);
}

void RingReader::open(const std::filesystem::path& path) {
  if (fd_ >= 0) ::close(fd_);
  path_ = path;
  fd_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  decoder_ = {};
}

bool RingReader::open_next() {
  for (const DiskRing::Part& part : ring_->past_.parts) {
    if (part.path <= path_) continue;
    open(part.path);
    if (fd_ >= 0) return true;
  }
  return false;
}

bool RingReader::read(const std::function<void(const RingRecord&)>& show) {
  if (fd_ < 0) return false;
  std::string piece(kPiece, '\0');
  const ssize_t n = ::read(fd_, piece.data(), piece.size());
  if (n <= 0) return open_next();
  decoder_.feed(std::string_view(piece).substr(0, static_cast<std::size_t>(n)));
  while (const auto record = decoder_.next()) {
    const auto kept = ring_record(*record);
    if (!kept || !is_line(*kept) || kept->to_seq < seq_) continue;
    show(*kept);
    seq_ = kept->to_seq + 1;
  }
  return decoder_.state() != RawLogDecoder::State::damaged || open_next();
}

}  // namespace mgtd::daemon::store
