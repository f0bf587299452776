// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <utility>

#include <array>
#include <boost/asio/generic/stream_protocol.hpp>
#include <memory>
#include <string>
#include <string_view>

#include "daemon/serve/peer.h"
#include "proto/line_framer.h"

/// A LineConnection is a Peer on a TCP or Unix socket. Reads a kilobyte at a time, so that a peer
/// that floods costs the others no more than that per turn; writes without ever blocking. Everything runs on
/// the io_context's thread.
namespace mgtd::daemon::serve {

class LineConnection final : public Peer, public std::enable_shared_from_this<LineConnection> {
 public:
  static constexpr std::size_t kBatch = 65'536;
  using Socket = boost::asio::generic::stream_protocol::socket;

  LineConnection(Socket socket, std::size_t line_limit);

  void start(Handlers handlers) override;
  void send(std::string_view bytes) override;
  void flush() override;
  void close(std::string_view reason) override;

  [[nodiscard]] bool open() const override { return open_; }
  [[nodiscard]] std::size_t backlog() const override { return out_.size() - written_; }
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
