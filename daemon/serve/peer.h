// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

/// A Peer is the other end of a connection and speaks in lines, over a socket (line_connection.h) or a
/// WebSocket (console/web_peer.h). Writing never blocks. Everything runs on the io_context's thread.
namespace mgtd::daemon::serve {

class Peer {
 public:
  struct Handlers {
    std::function<void(std::string_view)> on_line;
    std::function<void()> on_overlong;
    /// Appends what is due, when the peer can take more; is asked again when it filled the buffer.
    std::function<void(std::string&)> refill;
    /// Whether the peer is still owed something when it has ended its sending ("echo ... | nc" does); without
    /// this handler it is not, and is closed.
    std::function<bool()> keep_after_end;
    /// Called once, with the reason; nothing is called afterwards.
    std::function<void(std::string_view)> on_close;
  };

  Peer() = default;
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;
  virtual ~Peer() = default;

  virtual void start(Handlers handlers) = 0;
  /// Queues bytes and writes what the peer takes at once.
  virtual void send(std::string_view bytes) = 0;
  /// Asks refill for what is due and writes what the peer takes at once.
  virtual void flush() = 0;
  /// At once; what the peer has not taken is lost.
  virtual void close(std::string_view reason) = 0;

  [[nodiscard]] virtual bool open() const = 0;
  /// Bytes queued that the peer has not taken.
  [[nodiscard]] virtual std::size_t backlog() const = 0;
};

}  // namespace mgtd::daemon::serve
