// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

/// A Pty is a pseudo-terminal with a stable name; to the host it is a USB serial adapter. Closing it is
/// pulling the plug.
namespace mgtd::rig {

class Pty {
 public:
  /// Makes a raw pty and links it at `link`. is_open() tells whether that worked; why() what did not.
  explicit Pty(std::string link);
  ~Pty() { close(); }
  Pty(const Pty&) = delete;
  Pty& operator=(const Pty&) = delete;

  void open();
  /// The link is removed and the host sees a hang-up.
  void close();
  [[nodiscard]] bool is_open() const { return master_ >= 0; }
  [[nodiscard]] const std::string& why() const { return why_; }

  /// Bytes the host wrote since the last call; never blocks.
  [[nodiscard]] std::string read();
  /// Whether a host had the port open at the last read(). What is said to nobody is lost.
  [[nodiscard]] bool listened() const { return listened_; }
  /// Writes what fits and returns how much that was; never blocks.
  [[nodiscard]] std::size_t write(std::string_view bytes);

 private:
  [[nodiscard]] bool make(std::string& terminal);

  std::string link_, why_;
  int master_{-1};
  bool listened_{false};
};

}  // namespace mgtd::rig
