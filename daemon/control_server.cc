// SPDX-License-Identifier: Apache-2.0
#include "daemon/control_server.h"

#include <fmt/format.h>

#include <optional>
#include <vector>

#include "daemon/line_connection.h"
#include "daemon/listener.h"

namespace mgtd::daemon {
namespace {

constexpr std::size_t kReplyBacklog = 4 * 1024 * 1024;  // bytes of replies a client may leave unread

using Connection = std::shared_ptr<LineConnection>;

std::string refusal(const Error& error, const nlohmann::json& id) {
  return encode_reply(id, tl::unexpected(error)) + '\n';
}

}  // namespace

class ControlServer::State : public std::enable_shared_from_this<State> {
 public:
  State(boost::asio::io_context& io, ControlConfig config, Handler handler)
      : io_(io), config_(std::move(config)), handler_(std::move(handler)) {}

  Result<void> start() {
    auto listener = Listener::unix_socket(io_, config_.path, config_.mode);
    if (!listener) return tl::unexpected(listener.error());
    listener_ = std::move(*listener);
    listener_->start([weak = weak_from_this()](LineConnection::Socket socket) {
      if (const auto self = weak.lock()) self->admit(std::move(socket));
    });
    return {};
  }

  void stop() {
    listener_.reset();
    for (const Connection& client : std::vector(clients_)) client->close("the daemon is stopping");
  }

  [[nodiscard]] std::size_t clients() const { return clients_.size(); }

 private:
  void admit(LineConnection::Socket socket) {
    const auto client = std::make_shared<LineConnection>(std::move(socket), kControlLineLimit);
    if (clients_.size() >= config_.max_clients) {
      client->send(
          refusal({ErrorCode::state,
                   fmt::format("{} control clients are connected, which is the limit", clients_.size()),
                   "end another mgt first"},
                  nullptr));
      return client->close("too many clients");
    }
    clients_.push_back(client);
    client->start({.on_line = [this, raw = client.get()](std::string_view line) { on_line(*raw, line); },
                   .on_overlong = [raw = client.get()] { on_overlong(*raw); },
                   .refill = [](std::string&) {},
                   .keep_after_end = {},
                   .on_close = [this, raw = client.get()](std::string_view) { forget(raw); }});
  }

  void on_line(LineConnection& client, std::string_view line) {
    const auto request = parse_control(line);
    client.send(request ? encode_reply(request->id, handler_(*request)) + '\n'
                        : refusal(request.error().error, request.error().id));
    if (client.backlog() > kReplyBacklog) client.close("the client does not read its replies");
  }

  static void on_overlong(LineConnection& client) {
    client.send(refusal(
        {ErrorCode::bad_input, fmt::format("the request is longer than {} bytes", kControlLineLimit), ""},
        nullptr));
    client.close("a request was too long");
  }

  void forget(const LineConnection* client) {
    std::erase_if(clients_, [&](const Connection& held) { return held.get() == client; });
  }

  boost::asio::io_context& io_;
  ControlConfig config_;
  Handler handler_;
  std::optional<Listener> listener_;
  std::vector<Connection> clients_;
};

ControlServer::ControlServer(boost::asio::io_context& io, ControlConfig config, Handler handler)
    : state_(std::make_shared<State>(io, std::move(config), std::move(handler))) {}
ControlServer::~ControlServer() { state_->stop(); }
Result<void> ControlServer::start() { return state_->start(); }
void ControlServer::stop() { state_->stop(); }
std::size_t ControlServer::clients() const { return state_->clients(); }

}  // namespace mgtd::daemon
