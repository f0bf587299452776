// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

/// A LinePeer is a client of a socket made of system calls only, so that servers are tested against the
/// kernel and not against our own client. Never blocks: pump() takes what has arrived.
namespace mgtd::testing {

class LinePeer {
 public:
  static LinePeer unix_socket(const std::string& path);
  static LinePeer tcp(std::uint16_t port);
  LinePeer(LinePeer&& other) noexcept;
  LinePeer& operator=(LinePeer&&) = delete;
  ~LinePeer();

  [[nodiscard]] bool connected() const { return fd_ >= 0; }
  /// Bytes the kernel took; fewer than given when its buffer is full or the peer is gone.
  std::size_t send(std::string_view bytes);
  std::size_t send_line(std::string_view line) { return send(std::string(line) + "\n"); }
  /// Reads what is there, at most `limit` bytes.
  void pump(std::size_t limit = SIZE_MAX);
  void close();
  /// Sends no more, still listens.
  void end_sending() const;

  std::vector<std::string> lines;  ///< complete ones so far
  bool closed{false};              ///< the other side hung up

  /// Lines that contain the text.
  [[nodiscard]] std::size_t count(std::string_view text) const;

 private:
  explicit LinePeer(int fd) : fd_(fd) {}
  int fd_;
  std::string pending_;
};

}  // namespace mgtd::testing
