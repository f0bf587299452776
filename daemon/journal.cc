// SPDX-License-Identifier: Apache-2.0
#include "daemon/journal.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace mgtd::daemon {
namespace {

constexpr int kMaxFiles = 1'000'000;

}  // namespace

Result<Journal> Journal::open(JournalConfig config, Instant now) {
  std::error_code error;
  std::filesystem::create_directories(config.directory, error);
  Journal journal(std::move(config));
  if (auto ok = journal.retry(now); !ok) return tl::unexpected(ok.error());
  return journal;
}

Journal::Journal(Journal&& other) noexcept { *this = std::move(other); }

Journal& Journal::operator=(Journal&& other) noexcept {
  if (this == &other) return *this;
  close();
  config_ = std::move(other.config_);
  file_ = std::move(other.file_);
  fd_ = std::exchange(other.fd_, -1);
  number_ = other.number_;
  buffer_ = std::exchange(other.buffer_, {});
  in_file_ = other.in_file_;
  written_ = other.written_;
  lost_ = other.lost_;
  last_write_ = other.last_write_;
  last_sync_ = other.last_sync_;
  unsynced_ = std::exchange(other.unsynced_, false);
  error_ = std::move(other.error_);
  return *this;
}

Journal::~Journal() { close(); }

Result<void> Journal::retry(Instant now) {
  if (recording()) return {};
  last_write_ = last_sync_ = now;
  error_.reset();
  return start_file();
}

/// The next number that is free: a journal is never written over.
Result<void> Journal::start_file() {
  do {
    file_ = config_.directory / fmt::format("{}.{:03}.raw", config_.name, number_++);
    fd_ = ::open(file_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0640);
  } while (fd_ < 0 && errno == EEXIST && number_ < kMaxFiles);
  if (fd_ < 0) {
    return fail(ErrorCode::io, fmt::format("cannot create {}: {}", file_.string(), std::strerror(errno)),
                "check the directory's owner and the space on its disk");
  }
  in_file_ = 0;
  buffer_.insert(0, encode_header(config_.header));
  return {};
}

void Journal::append(const RawRecord& record) {
  if (!recording()) {
    lost_ += record.bytes.size();
    return;
  }
  encode_record(record, buffer_);
  if (buffer_.size() >= config_.buffer_bytes) flush();
}

void Journal::tick(Instant now) {
  if (!recording()) return;
  if (now - last_write_ >= config_.write_every) {
    last_write_ = now;
    flush();
  }
  if (recording() && unsynced_ && now - last_sync_ >= config_.sync_every) {
    last_sync_ = now;
    unsynced_ = false;
    if (::fdatasync(fd_) != 0) stop(errno, "sync");
  }
}

void Journal::flush() {
  std::size_t done = 0;
  while (done < buffer_.size()) {
    const ssize_t n = ::write(fd_, buffer_.data() + done, buffer_.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) {
      const int os_error = n == 0 ? ENOSPC : errno;
      lost_ += buffer_.size() - done;
      stop(os_error, "write");
      return;
    }
    done += static_cast<std::size_t>(n);
    in_file_ += static_cast<std::uint64_t>(n);
    written_ += static_cast<std::uint64_t>(n);
    unsynced_ = true;
  }
  buffer_.clear();
  if (in_file_ < config_.rotate_bytes) return;
  close();
  if (auto next = start_file(); !next) error_ = next.error();
}

void Journal::close() {
  if (fd_ < 0) return;
  if (!buffer_.empty()) {
    const std::uint64_t rotate = std::exchange(config_.rotate_bytes, UINT64_MAX);
    flush();
    config_.rotate_bytes = rotate;
  }
  if (fd_ < 0) return;
  ::fdatasync(fd_);
  ::close(std::exchange(fd_, -1));
  unsynced_ = false;
}

void Journal::stop(int os_error, const char* doing) {
  error_ = Error{ErrorCode::io,
                 fmt::format("cannot {} {}: {}; raw bytes are no longer recorded, everything else goes on",
                             doing, file_.string(), std::strerror(os_error)),
                 "free space on its disk; recording starts again with the next run"};
  buffer_.clear();
  ::close(std::exchange(fd_, -1));
}

std::optional<Error> Journal::take_error() { return std::exchange(error_, std::nullopt); }

}  // namespace mgtd::daemon
