// SPDX-License-Identifier: Apache-2.0
#include "daemon/serve/line_stream.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>

#include "daemon/config/tcp_address.h"
#include "daemon/serve/unix_socket.h"

namespace mgtd::daemon::serve {
namespace {

using Clock = std::chrono::steady_clock;

/// Milliseconds left, rounded up, so that a wait never ends early.
int left_ms(Clock::time_point end) {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now()).count();
  return static_cast<int>(std::clamp<std::int64_t>(left, 0, 3'600'000));
}

}  // namespace

Result<LineStream> LineStream::connect_unix(const std::string& path) {
  const auto fd = serve::connect_unix(path);
  if (!fd) return tl::unexpected(fd.error());
  return LineStream(*fd, path);
}

Result<LineStream> LineStream::connect_tcp(const std::string& address) {
  const auto endpoint = config::parse_tcp_address(address);
  if (!endpoint) return tl::unexpected(endpoint.error());
  const int fd = ::socket(endpoint->protocol().family(), SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (fd >= 0 && ::connect(fd, endpoint->data(), static_cast<socklen_t>(endpoint->size())) == 0) {
    return LineStream(fd, address);
  }
  const int error = errno;
  if (fd >= 0) ::close(fd);
  return fail(ErrorCode::unreachable,
              fmt::format("no daemon answers at {}: {}", address, std::strerror(error)),
              "is mgtd running (systemctl status mgtd)? is this its stream (key tcp under [stream])?");
}

LineStream::LineStream(LineStream&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)), where_(std::move(other.where_)), in_(std::move(other.in_)) {}

LineStream& LineStream::operator=(LineStream&& other) noexcept {
  std::swap(fd_, other.fd_);
  std::swap(where_, other.where_);
  std::swap(in_, other.in_);
  return *this;
}

LineStream::~LineStream() {
  if (fd_ >= 0) ::close(fd_);
}

Result<void> LineStream::send_line(std::string_view line) {
  const std::string bytes = std::string(line) + '\n';
  std::size_t sent = 0;
  while (sent < bytes.size()) {
    const ssize_t n = ::send(fd_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) {
      return fail(ErrorCode::unreachable,
                  fmt::format("the daemon at {} hung up: {}", where_, std::strerror(errno)),
                  "systemctl status mgtd says why it ended");
    }
    sent += static_cast<std::size_t>(n);
  }
  return {};
}

Result<std::optional<std::string>> LineStream::read_line(Duration wait) {
  const Clock::time_point end = Clock::now() + wait;
  for (std::size_t searched = 0;;) {
    if (const std::size_t at = in_.find('\n', searched); at != std::string::npos) {
      std::string line = in_.substr(0, at);
      in_.erase(0, at + 1);
      return line;
    }
    searched = in_.size();
    pollfd readable{fd_, POLLIN, 0};
    const int ready = ::poll(&readable, 1, left_ms(end));
    if (ready == 0) return std::nullopt;
    if (ready < 0 && errno == EINTR) return std::nullopt;  // a signal: let the caller look
    std::array<char, 16'384> bytes;
    const ssize_t n = ::recv(fd_, bytes.data(), bytes.size(), 0);
    if (n > 0) {
      in_.append(bytes.data(), static_cast<std::size_t>(n));
    } else if (n == 0 || errno != EINTR) {
      return fail(ErrorCode::unreachable,
                  fmt::format("the daemon at {} closed the connection{}{}", where_, n < 0 ? ": " : "",
                              n < 0 ? std::strerror(errno) : ""),
                  "systemctl status mgtd says why it ended");
    }
  }
}

}  // namespace mgtd::daemon::serve
