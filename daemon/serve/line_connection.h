// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <utility>

#include <array>
#include <boost/asio/generic/stream_protocol.hpp>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "proto/line_framer.h"

/// A LineConnection is one connected peer that speaks in lines. Reads a kilobyte at a time, so that a peer
/// that floods costs the others no more than that per turn; writes without ever blocking. Everything runs on
/// the io_context's thread.
namespace mgtd::daemon::serve {

class LineConnection : public std::enable_shared_from_this<LineConnection> {
 public:
  static constexpr std::size_t kBatch = 65'536;
  using Socket = boost::asio::generic::stream_protocol::socket;

  struct Handlers {
    std::function<void(std::string_view)> on_line;
    std::function<void()> on_overlong;
    /// Appends what is due, when the peer can take more; is asked again when it filled the buffer to kBatch.
    std::function<void(std::string&)> refill;
    /// Whether the peer is still owed something when it has ended its sending ("echo ... | nc" does); without
    /// this handler it is not, and is closed.
    std::function<bool()> keep_after_end;
    /// Called once, with the reason; nothing is called afterwards.
    std::function<void(std::string_view)> on_close;
  };

  LineConnection(Socket socket, std::size_t line_limit);

  void start(Handlers handlers);
  /// Queues bytes and writes what the peer takes at once.
  void send(std::string_view bytes);
  /// Asks refill for what is due and writes what the peer takes at once.
  void flush();
  /// At once; what the peer has not taken is lost.
  void close(std::string_view reason);

  [[nodiscard]] bool open() const { return open_; }
  /// Bytes queued that the peer has not taken.
  [[nodiscard]] std::size_t backlog() const { return out_.size() - written_; }
  [[nodiscard]] std::uint64_t bytes_out() const { return bytes_out_; }

 private:
  void read();
  void received(std::string_view bytes);
  void sending_ended();
  void write();
  void await_writable();

  Socket socket_;
  Handlers handlers_;
  LineFramer framer_;
  std::array<char, 1024> in_{};
  std::string out_;
  std::size_t written_{0};  ///< of out_
  std::uint64_t bytes_out_{0};
  bool open_{true};
  bool waiting_{false};  ///< for the socket to become writable
};

}  // namespace mgtd::daemon::serve
