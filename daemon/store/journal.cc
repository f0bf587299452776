// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/journal.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace mgtd::daemon::store {
namespace {

void sync_and_close(int fd) {
  ::fdatasync(fd);
  ::close(fd);
}

}  // namespace

Journal::Journal(JournalConfig config, Instant now)
    : config_(std::move(config)), now_(now), last_write_(now), last_sync_(now), last_try_(now) {
  if (config_.family.empty()) config_.family = config_.name + ".";
  start_file();
}

Journal::~Journal() {
  if (recording() && !buffer_.empty()) flush();
  if (recording()) sync_and_close(file_.fd);
  for (const int fd : syncs_) sync_and_close(fd);
}

/// A number that is free: a journal is never written over.
void Journal::start_file() {
  std::error_code error;
  std::filesystem::create_directories(config_.directory, error);
  std::uint64_t number = next_number(config_.directory, config_.name, config_.suffix);
  removed_ += remove_oldest(by_age(rotated_files(config_.directory, config_.family, config_.suffix),
                                   config_.name, std::filesystem::file_time_type::clock::now()),
                            config_.keep, config_.rotate_bytes);
  do {
    file_.path = rotated_name(config_.directory, config_.name, number++, config_.suffix);
    file_.fd = ::open(file_.path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0640);
  } while (file_.fd < 0 && errno == EEXIST);
  if (file_.fd < 0) return stop(refused(errno, "create"));
  file_.bytes = file_.header = 0;  // no longer those of the file before
  RawLogHeader names = config_.header;
  if (names.run_id.empty()) names.run_id = file_.path.stem().string();
  const std::string header = encode_header(names);
  if (const ssize_t n = ::write(file_.fd, header.data(), header.size());
      n != static_cast<ssize_t>(header.size())) {
    const int os_error = n < 0 ? errno : ENOSPC;
    ::unlink(file_.path.c_str());
    return stop(refused(os_error, "write"));
  }
  file_.bytes = header.size();
  written_ += header.size();
  file_.unsynced = true;
  file_.since = now_;
  file_.header = file_.bytes;
  encoder_ = {};
}

void Journal::append(const RawRecord& record) {
  if (!recording()) {
    lost_ += record.bytes.size();
    return;
  }
  encoder_.encode(record, buffer_);
  if (buffer_.size() >= config_.buffer_bytes) flush();
}

void Journal::tick(Instant now) {
  now_ = now;
  if (!recording()) {
    if (held_ || now - last_try_ < config_.retry_every) return;
    last_try_ = now;
    start_file();
  }
  if (now - last_write_ < config_.write_every) return;
  last_write_ = now;
  flush();
}

void Journal::flush() {
  std::size_t done = 0;
  while (recording() && done < buffer_.size()) {
    const ssize_t n = ::write(file_.fd, buffer_.data() + done, buffer_.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) {
      const int os_error = n == 0 ? ENOSPC : errno;
      buffer_.erase(0, done);
      return stop(refused(os_error, "write"));
    }
    done += static_cast<std::size_t>(n);
    file_.bytes += static_cast<std::uint64_t>(n);
    written_ += static_cast<std::uint64_t>(n);
    file_.unsynced = true;
  }
  if (recording() && file_.bytes > file_.header && trouble_) {  // a disk that takes a header may take no more
    resumed_ = true;
    trouble_.reset();
  }
  buffer_.clear();
  if (file_.bytes >= config_.rotate_bytes || now_ - file_.since >= config_.rotate_after) rotate();
}

void Journal::rotate() {
  if (!recording()) return;
  syncs_.push_back(std::exchange(file_.fd, -1));
  file_.unsynced = false;
  start_file();
}

std::vector<int> Journal::take_syncs() {
  std::vector<int> out = std::exchange(syncs_, {});
  if (recording() && file_.unsynced && now_ - last_sync_ >= config_.sync_every) {
    last_sync_ = now_;
    file_.unsynced = false;
    if (const int copy = ::fcntl(file_.fd, F_DUPFD_CLOEXEC, 0); copy >= 0) out.push_back(copy);
  }
  return out;
}

void Journal::synced(int os_error) {
  if (os_error != 0 && recording()) stop(refused(os_error, "sync"));
}

void Journal::hold(Error why) {
  if (std::exchange(held_, true)) {
    if (!recording()) trouble_ = std::move(why);  // what is measured now
    return;
  }
  if (recording() && !buffer_.empty()) flush();
  stop(std::move(why));
}

void Journal::release() {
  if (!std::exchange(held_, false) || recording()) return;
  last_try_ = now_;
  start_file();
}

Error Journal::refused(int os_error, const char* doing) const {
  return {ErrorCode::io,
          fmt::format("cannot {} {}: {}; {} are no longer recorded, everything else goes on", doing,
                      file_.path.string(), std::strerror(os_error), config_.what),
          os_error == ENOSPC || os_error == EDQUOT || os_error == EFBIG
              ? "free space on its disk; recording goes on by itself"
              : "check the disk and the directory's owner; recording goes on by itself"};
}

void Journal::stop(Error why) {
  lost_ += std::exchange(buffer_, {}).size();
  if (recording() && trouble_) {  // it is tried every retry_every: a try leaves nothing behind
    lost_ += file_.bytes - file_.header;
    ::unlink(file_.path.c_str());
  }
  if (recording()) ::close(std::exchange(file_.fd, -1));
  if (!trouble_) {
    ++stops_;
    unreported_ = why;
    resumed_ = false;
  }
  trouble_ = std::move(why);
}

std::optional<Error> Journal::take_error() { return std::exchange(unreported_, std::nullopt); }

std::optional<std::uint64_t> Journal::take_resumed() {
  if (!std::exchange(resumed_, false)) return std::nullopt;
  return lost_ - std::exchange(lost_reported_, lost_);
}

}  // namespace mgtd::daemon::store
