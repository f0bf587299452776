// SPDX-License-Identifier: Apache-2.0
#include "daemon/serve/listener.h"

#include <fmt/format.h>
#include <netinet/tcp.h>

#include <boost/asio/basic_socket_acceptor.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>

#include "daemon/config/tcp_address.h"
#include "daemon/serve/inherited_sockets.h"
#include "daemon/serve/unix_socket.h"

namespace mgtd::daemon::serve {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

namespace {

/// Bounds what the kernel holds for a client that does not read, and so how old its next line can be.
constexpr int kSendBuffer = 256 * 1024;

/// A whole-number option of TCP, as Asio wants it.
struct TcpOption {
  int number;
  int value;
  [[nodiscard]] static int level(const asio::generic::stream_protocol&) { return IPPROTO_TCP; }
  [[nodiscard]] int name(const asio::generic::stream_protocol&) const { return number; }
  [[nodiscard]] const int* data(const asio::generic::stream_protocol&) const { return &value; }
  [[nodiscard]] static std::size_t size(const asio::generic::stream_protocol&) { return sizeof(int); }
};

/// TCP options fail on a Unix socket, which needs none of them.
void prepare(Listener::Socket& socket) {
  error_code ignored;
  socket.set_option(asio::socket_base::send_buffer_size(kSendBuffer), ignored);
  socket.set_option(tcp::no_delay(true), ignored);
  // A client that vanished without a word is noticed within two minutes.
  socket.set_option(asio::socket_base::keep_alive(true), ignored);
  socket.set_option(TcpOption{TCP_KEEPIDLE, 30}, ignored);
  socket.set_option(TcpOption{TCP_KEEPINTVL, 10}, ignored);
}

tl::unexpected<Error> cannot_listen(const std::string& address, const tcp::endpoint& endpoint,
                                    const error_code& ec) {
  if (ec == asio::error::address_in_use) {
    return fail(
        ErrorCode::io, fmt::format("{} is occupied by another program", address),
        fmt::format("is mgtd running already (systemctl status mgtd)? \"ss -ltnp sport = :{}\" shows who "
                    "has the port; or choose another in the configuration",
                    endpoint.port()));
  }
  return fail(ErrorCode::io, fmt::format("cannot listen at {}: {}", address, ec.message()),
              "use an address of this machine (\"ip address\" lists them) and a port above 1023");
}

}  // namespace

class Listener::State : public std::enable_shared_from_this<State> {
 public:
  using Acceptor = asio::basic_socket_acceptor<asio::generic::stream_protocol>;

  State(Acceptor acceptor, std::uint16_t port, UnixSocket file)
      : acceptor_(std::move(acceptor)),
        pause_(acceptor_.get_executor()),
        port_(port),
        file_(std::move(file)) {}

  void start(OnClient on_client) {
    on_client_ = std::move(on_client);
    accept();
  }

  void stop() {
    stopped_ = true;
    error_code ignored;
    acceptor_.close(ignored);
    pause_.cancel();
    file_.remove();
  }

  [[nodiscard]] std::uint16_t port() const { return port_; }

 private:
  void accept() {
    acceptor_.async_accept([self = shared_from_this()](error_code ec, Socket socket) {
      if (self->stopped_) return;
      if (ec) return self->accept_later();
      prepare(socket);
      self->on_client_(std::move(socket));
      if (!self->stopped_) self->accept();
    });
  }

  void accept_later() {
    pause_.expires_after(std::chrono::seconds(1));
    pause_.async_wait([self = shared_from_this()](error_code) {
      if (!self->stopped_) self->accept();
    });
  }

  Acceptor acceptor_;
  asio::steady_timer pause_;
  std::uint16_t port_;
  UnixSocket file_;
  OnClient on_client_;
  bool stopped_{false};
};

Result<Listener> Listener::tcp(asio::io_context& io, const std::string& address) {
  const auto endpoint = config::parse_tcp_address(address);
  if (!endpoint) return tl::unexpected(endpoint.error());
  if (const int fd = take_inherited_tcp(*endpoint); fd >= 0) {
    return Listener(
        std::make_shared<State>(State::Acceptor(io, asio::generic::stream_protocol(endpoint->protocol()), fd),
                                endpoint->port(), UnixSocket()));
  }
  tcp::acceptor acceptor(io);
  error_code ec;
  acceptor.open(endpoint->protocol(), ec);
  if (!ec) acceptor.set_option(asio::socket_base::reuse_address(true), ec);
  if (!ec) acceptor.bind(*endpoint, ec);
  if (!ec) acceptor.listen(asio::socket_base::max_listen_connections, ec);
  const tcp::endpoint bound = ec ? tcp::endpoint() : acceptor.local_endpoint(ec);
  const int fd = ec ? -1 : acceptor.release(ec);
  if (ec) return cannot_listen(address, *endpoint, ec);
  return Listener(std::make_shared<State>(
      State::Acceptor(io, asio::generic::stream_protocol(bound.protocol()), fd), bound.port(), UnixSocket()));
}

Result<Listener> Listener::unix_socket(asio::io_context& io, const std::string& path, int mode) {
  // The file of an inherited socket, and its permissions, are the service manager's.
  const int inherited = take_inherited_unix(path);
  Result<UnixSocket> file = inherited >= 0 ? UnixSocket() : UnixSocket::listen(path, mode);
  if (!file) return tl::unexpected(file.error());
  State::Acceptor acceptor(io, asio::generic::stream_protocol(AF_UNIX, 0),
                           inherited >= 0 ? inherited : file->release());
  return Listener(std::make_shared<State>(std::move(acceptor), std::uint16_t{0}, std::move(*file)));
}

Listener::Listener(std::shared_ptr<State> state) : state_(std::move(state)) {}
Listener::Listener(Listener&&) noexcept = default;
Listener& Listener::operator=(Listener&&) noexcept = default;
Listener::~Listener() {
  if (state_) state_->stop();
}

void Listener::start(OnClient on_client) { state_->start(std::move(on_client)); }
void Listener::stop() { state_->stop(); }
std::uint16_t Listener::port() const { return state_->port(); }

}  // namespace mgtd::daemon::serve
