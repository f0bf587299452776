// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/durable_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

namespace mgtd::daemon::store {
namespace {

Error cannot(const char* what, const std::filesystem::path& path, int os_error) {
  return {ErrorCode::io, fmt::format("cannot {} {}: {}", what, path.string(), std::strerror(os_error)),
          os_error == ENOSPC || os_error == EDQUOT || os_error == EFBIG
              ? "free space on its disk"
              : "check path, owner and permissions"};
}

/// Writes all, syncs, closes; 0 or errno.
int write_and_close(int fd, std::string_view text) {
  int code = 0;
  while (!text.empty() && code == 0) {
    const ssize_t n = ::write(fd, text.data(), text.size());
    if (n > 0) {
      text.remove_prefix(static_cast<std::size_t>(n));
    } else if (n == 0 || errno != EINTR) {
      code = n == 0 ? ENOSPC : errno;
    }
  }
  if (code == 0 && ::fsync(fd) != 0) code = errno;
  if (::close(fd) != 0 && code == 0) code = errno;
  return code;
}

/// 0 or errno.
int read_to_end(int fd, std::string& text) {
  std::array<char, 1U << 16U> piece;
  for (;;) {
    const ssize_t n = ::read(fd, piece.data(), piece.size());
    if (n > 0) text.append(piece.data(), static_cast<std::size_t>(n));
    if (n == 0) return 0;
    if (n < 0 && errno != EINTR) return errno;
  }
}

Error unreadable(const std::filesystem::path& path, int os_error) {
  if (os_error == EISDIR)
    return {ErrorCode::bad_input, fmt::format("{} is a directory", path.string()), "name a file in it"};
  return {ErrorCode::bad_input, fmt::format("{} cannot be read: {}", path.string(), std::strerror(os_error)),
          "check path and permissions"};
}

}  // namespace

Result<void> sync_directory(const std::filesystem::path& directory) {
  const std::filesystem::path name = directory.empty() ? std::filesystem::path(".") : directory;
  const int fd = ::open(name.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) return tl::unexpected(cannot("open", name, errno));
  const int code = ::fsync(fd) == 0 ? 0 : errno;
  ::close(fd);
  if (code != 0 && code != EINVAL) return tl::unexpected(cannot("sync", name, code));
  return {};
}

Result<void> write_durably(const std::filesystem::path& path, std::string_view text) {
  const std::filesystem::path draft = path.string() + ".new";
  const int fd = ::open(draft.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (fd < 0) return tl::unexpected(cannot("create", draft, errno));
  int code = write_and_close(fd, text);
  if (code == 0 && std::rename(draft.c_str(), path.c_str()) != 0) code = errno;
  if (code == 0) return sync_directory(path.parent_path());
  ::unlink(draft.c_str());
  return tl::unexpected(cannot("write", path, code));
}

Result<void> append_durably(const std::filesystem::path& path, std::string_view text) {
  const bool is_new = ::access(path.c_str(), F_OK) != 0;
  const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (fd < 0) return tl::unexpected(cannot("open", path, errno));
  if (const int code = write_and_close(fd, text); code != 0)
    return tl::unexpected(cannot("write", path, code));
  return is_new ? sync_directory(path.parent_path()) : Result<void>{};
}

Result<std::string> read_file(const std::filesystem::path& path) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return tl::unexpected(unreadable(path, errno));
  std::string text;
  const int code = read_to_end(fd, text);
  ::close(fd);
  if (code != 0) return tl::unexpected(unreadable(path, code));
  return text;
}

}  // namespace mgtd::daemon::store
