// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <utility>

#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "proto/error.h"

/// A Listener waits for clients at a TCP address or a Unix socket and hands connected sockets to the server.
/// When file descriptors run out it pauses for a second instead of spinning.
namespace mgtd::daemon::serve {

class Listener {
 public:
  using Socket = boost::asio::generic::stream_protocol::socket;
  using OnClient = std::function<void(Socket)>;

  /// A socket that the service manager holds open at the same place is taken over (inherited_sockets.h).
  ///
  /// `address` is "127.0.0.1:7450", "[::1]:7450" or "localhost:7450"; port 0 takes any free one. Refused: an
  /// address that cannot be read, a port that is occupied (with what to do).
  [[nodiscard]] static Result<Listener> tcp(boost::asio::io_context& io, const std::string& address);
  /// As listen_unix (unix_socket.h).
  [[nodiscard]] static Result<Listener> unix_socket(boost::asio::io_context& io, const std::string& path,
                                                    int mode);

  Listener(Listener&&) noexcept;
  Listener& operator=(Listener&&) noexcept;
  ~Listener();

  void start(OnClient on_client);
  /// Stops listening and removes the Unix socket's file. Clients already given away stay.
  void stop();
  /// The port that was bound; 0 for a Unix socket.
  [[nodiscard]] std::uint16_t port() const;

 private:
  class State;
  explicit Listener(std::shared_ptr<State> state);
  std::shared_ptr<State> state_;
};

}  // namespace mgtd::daemon::serve
