// SPDX-License-Identifier: Apache-2.0
#include "daemon/serve/unix_socket.h"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace mgtd::daemon::serve {
namespace {

struct Address {
  sockaddr_un un{};
  [[nodiscard]] const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&un); }
};

Result<Address> address_of(const std::string& path) {
  Address address;
  if (path.empty() || path.size() >= sizeof(address.un.sun_path)) {
    return fail(ErrorCode::bad_input,
                fmt::format("socket path '{}' has {} characters; 1 to {} are possible", path, path.size(),
                            sizeof(address.un.sun_path) - 1),
                "choose a shorter path");
  }
  address.un.sun_family = AF_UNIX;
  std::memcpy(address.un.sun_path, path.data(), path.size());
  return address;
}

tl::unexpected<Error> cannot_listen(const std::string& path, int error) {
  const bool no_directory = error == ENOENT || error == ENOTDIR;
  return fail(ErrorCode::io, fmt::format("cannot listen at {}: {}", path, std::strerror(error)),
              no_directory ? "create its directory, or choose another path in the configuration"
                           : "see who may write its directory, or choose another path in the configuration");
}

/// Whether anybody listens at a socket file: only a refused connection says that nobody does.
Result<void> refuse_if_in_use(const std::string& path, const Address& address) {
  struct stat file {};
  if (::lstat(path.c_str(), &file) != 0) return {};
  if (!S_ISSOCK(file.st_mode)) {
    return fail(ErrorCode::io, fmt::format("{} exists and is not a socket", path),
                "remove it, or choose another path in the configuration");
  }
  const int fd = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (fd < 0) return cannot_listen(path, errno);
  const int error = ::connect(fd, address.get(), sizeof(address.un)) == 0 ? 0 : errno;
  ::close(fd);
  if (error == ECONNREFUSED || error == ENOENT) return {};
  if (error == EACCES) return cannot_listen(path, error);
  return fail(ErrorCode::state, fmt::format("another program is listening at {}", path),
              "is mgtd running already? stop it (systemctl stop mgtd), or choose another path in the "
              "configuration");
}

/// Listens at a name of its own; -1 and errno on failure.
int listen_at(const std::string& path, const Address& address, int mode) {
  const int fd = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (fd < 0) return -1;
  ::unlink(path.c_str());
  if (::bind(fd, address.get(), sizeof(address.un)) != 0 ||
      ::chmod(path.c_str(), static_cast<mode_t>(mode)) != 0 || ::listen(fd, SOMAXCONN) != 0) {
    const int error = errno;
    ::close(fd);
    ::unlink(path.c_str());
    errno = error;
    return -1;
  }
  return fd;
}

}  // namespace

Result<UnixSocket> UnixSocket::listen(const std::string& path, int mode) {
  const auto address = address_of(path);
  if (!address) return tl::unexpected(address.error());
  // Made beside its place and moved there, so that nobody meets it half ready or with other permissions.
  const std::string made = path + ".new";
  const auto made_address = address_of(made);
  if (!made_address) return tl::unexpected(made_address.error());
  if (auto free = refuse_if_in_use(path, *address); !free) return tl::unexpected(free.error());
  const int fd = listen_at(made, *made_address, mode);
  if (fd < 0) return cannot_listen(path, errno);
  UnixSocket socket;
  socket.fd_ = fd;
  struct stat file {};
  if (::stat(made.c_str(), &file) != 0 || ::rename(made.c_str(), path.c_str()) != 0) {
    const int error = errno;
    ::unlink(made.c_str());
    return cannot_listen(path, error);
  }
  socket.path_ = path;
  socket.device_ = file.st_dev;
  socket.inode_ = file.st_ino;
  return socket;
}

UnixSocket& UnixSocket::operator=(UnixSocket&& other) noexcept {
  std::swap(fd_, other.fd_);
  std::swap(path_, other.path_);
  std::swap(device_, other.device_);
  std::swap(inode_, other.inode_);
  return *this;
}

UnixSocket::~UnixSocket() {
  if (fd_ >= 0) ::close(fd_);
  remove();
}

void UnixSocket::remove() {
  struct stat file {};
  if (!path_.empty() && ::lstat(path_.c_str(), &file) == 0 && file.st_dev == device_ &&
      file.st_ino == inode_) {
    ::unlink(path_.c_str());
  }
  path_.clear();
}

Result<int> connect_unix(const std::string& path) {
  const auto address = address_of(path);
  if (!address) return tl::unexpected(address.error());
  const int fd = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (fd >= 0 && ::connect(fd, address->get(), sizeof(address->un)) == 0) return fd;
  const int error = errno;
  if (fd >= 0) ::close(fd);
  return fail(ErrorCode::unreachable, fmt::format("no daemon answers at {}: {}", path, std::strerror(error)),
              error == EACCES
                  ? "you may not use this socket: become a member of its group (ls -l shows it)"
                  : "is mgtd running (systemctl status mgtd)? is this its socket (--socket, MGTD_CONTROL)?");
}

}  // namespace mgtd::daemon::serve
