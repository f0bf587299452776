// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <utility>

#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/beast/core/basic_stream.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <memory>
#include <string>
#include <string_view>

#include "daemon/serve/peer.h"

/// A WebPeer is a Peer on a WebSocket: a text frame that comes is one line, a frame that goes holds as
/// many lines as were due. One write is in flight at a time; what becomes due meanwhile is asked for when it
/// has ended, so that a browser that does not read holds no more than one batch.
namespace mgtd::daemon::serve::console {

using WebStream =
    boost::beast::websocket::stream<boost::beast::basic_stream<boost::asio::generic::stream_protocol>>;

class WebPeer final : public Peer, public std::enable_shared_from_this<WebPeer> {
 public:
  /// `stream`: after its handshake. Longer frames than `line_limit` end the connection.
  WebPeer(WebStream stream, std::size_t line_limit);

  void start(Handlers handlers) override;
  void send(std::string_view bytes) override;
  void flush() override;
  void close(std::string_view reason) override;

  [[nodiscard]] bool open() const override { return open_; }
  [[nodiscard]] std::size_t backlog() const override { return due_.size() + flying_.size(); }

 private:
  void read();
  void write();

  WebStream stream_;
  Handlers handlers_;
  boost::beast::flat_buffer in_;
  std::string due_, flying_;
  bool open_{true}, writing_{false};
};

}  // namespace mgtd::daemon::serve::console
