// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/types.h>

#include <string>
#include <utility>

#include "proto/error.h"

/// Unix sockets are files; the mode of the file says who may connect.
namespace mgtd::daemon::serve {

/// A listening socket and the file it is known by. Owns both.
class UnixSocket {
 public:
  /// Listens at `path` with permissions `mode`. The file appears ready and with its permissions in one step.
  /// A socket left by a dead daemon is replaced; refused are a path where another program answers, a path
  /// that is no socket, and one that is too long or in a directory that does not exist.
  [[nodiscard]] static Result<UnixSocket> listen(const std::string& path, int mode);

  UnixSocket() = default;
  UnixSocket(UnixSocket&& other) noexcept { *this = std::move(other); }
  UnixSocket& operator=(UnixSocket&& other) noexcept;
  ~UnixSocket();

  /// Gives the file descriptor away; the file stays until this object goes.
  [[nodiscard]] int release() { return std::exchange(fd_, -1); }
  /// Removes the file if it still is this socket.
  void remove();

 private:
  int fd_{-1};
  std::string path_;
  dev_t device_{0};
  ino_t inode_{0};
};

/// A connected socket (close-on-exec), or `unreachable` with what to look at.
[[nodiscard]] Result<int> connect_unix(const std::string& path);

}  // namespace mgtd::daemon::serve
