// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/store_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string>
#include <string_view>

namespace mgtd::daemon::store {
namespace {

constexpr mode_t kMode = 0640;

std::string holder(int fd) {
  std::array<char, 32> text{};
  const ssize_t size = ::pread(fd, text.data(), text.size(), 0);
  std::string_view pid(text.data(), size > 0 ? static_cast<std::size_t>(size) : 0);
  pid = pid.substr(0, pid.find('\n'));
  return pid.empty() ? "another mgtd" : fmt::format("mgtd with pid {}", pid);
}

}  // namespace

Result<StoreLock> StoreLock::take(const std::filesystem::path& folder) {
  const auto io = [&](std::string_view doing, int error) {
    return fail(ErrorCode::io, fmt::format("{}: {}: {}", folder.string(), doing, std::strerror(error)),
                "see [store] dir in the configuration, and who owns the folder");
  };
  std::error_code ec;
  std::filesystem::create_directories(folder, ec);
  if (ec) return io("creating it", ec.value());
  const int fd = ::open((folder / "lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, kMode);
  if (fd < 0) return io("opening its lock", errno);
  StoreLock lock(fd);
  if (::flock(fd, LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK) return io("locking it", errno);
    return fail(ErrorCode::state, fmt::format("{} is in use by {}", folder.string(), holder(fd)),
                "one daemon for one rig: end that one first, or give this one a [store] dir of its own");
  }
  // For the message only; a lock without a name is still a lock.
  const std::string pid = fmt::format("{}\n", ::getpid());
  if (::ftruncate(fd, 0) == 0) static_cast<void>(::pwrite(fd, pid.data(), pid.size(), 0) == 0);
  return lock;
}

StoreLock::~StoreLock() {
  if (fd_ >= 0) ::close(fd_);
}

}  // namespace mgtd::daemon::store
