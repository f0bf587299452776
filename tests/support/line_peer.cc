// SPDX-License-Identifier: Apache-2.0
#include "tests/support/line_peer.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

namespace mgtd::testing {
namespace {

int connect_to(int domain, const sockaddr* address, socklen_t size) {
  const int fd = ::socket(domain, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (fd >= 0 && ::connect(fd, address, size) != 0) {
    ::close(fd);
    return -1;
  }
  return fd;
}

}  // namespace

LinePeer LinePeer::unix_socket(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path.copy(address.sun_path, sizeof(address.sun_path) - 1);
  return LinePeer(connect_to(AF_UNIX, reinterpret_cast<const sockaddr*>(&address), sizeof(address)));
}

LinePeer LinePeer::tcp(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return LinePeer(connect_to(AF_INET, reinterpret_cast<const sockaddr*>(&address), sizeof(address)));
}

LinePeer::LinePeer(LinePeer&& other) noexcept
    : lines(std::move(other.lines)),
      closed(other.closed),
      fd_(std::exchange(other.fd_, -1)),
      pending_(std::move(other.pending_)) {}

LinePeer::~LinePeer() { close(); }

std::size_t LinePeer::send(std::string_view bytes) {
  const ssize_t n = ::send(fd_, bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
  return n > 0 ? static_cast<std::size_t>(n) : 0;
}

void LinePeer::pump(std::size_t limit) {
  std::array<char, 4096> bytes;
  while (limit > 0 && !closed) {
    const ssize_t n = ::recv(fd_, bytes.data(), std::min(bytes.size(), limit), MSG_DONTWAIT);
    if (n < 0 && (errno == EAGAIN || errno == EINTR)) return;
    if (n <= 0) {
      closed = true;
      return;
    }
    limit -= static_cast<std::size_t>(n);
    pending_.append(bytes.data(), static_cast<std::size_t>(n));
    for (std::size_t end = pending_.find('\n'); end != std::string::npos; end = pending_.find('\n')) {
      lines.push_back(pending_.substr(0, end));
      pending_.erase(0, end + 1);
    }
  }
}

void LinePeer::close() {
  if (fd_ >= 0) ::close(std::exchange(fd_, -1));
}

void LinePeer::end_sending() const { ::shutdown(fd_, SHUT_WR); }

std::size_t LinePeer::count(std::string_view text) const {
  return static_cast<std::size_t>(std::count_if(lines.begin(), lines.end(), [&](const std::string& line) {
    return line.find(text) != std::string::npos;
  }));
}

}  // namespace mgtd::testing
