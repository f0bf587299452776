// SPDX-License-Identifier: Apache-2.0
#include "daemon/serve/control_server.h"

#include <fmt/format.h>
#include <pwd.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>
#include <nlohmann/json.hpp>

#include <optional>
#include <vector>

#include "daemon/serve/control_lease.h"
#include "daemon/serve/line_connection.h"
#include "daemon/serve/listener.h"
#include "drivers/clock.h"

namespace mgtd::daemon::serve {
namespace {

constexpr std::size_t kControlBacklog = 4 * 1024 * 1024;  // bytes of replies a client may leave unread

using Reply = Result<nlohmann::ordered_json>;

/// As the kernel knows who connected.
ControlPeer peer_of(LineConnection::Socket& socket) {
  ucred who{};
  socklen_t size = sizeof who;
  if (::getsockopt(socket.native_handle(), SOL_SOCKET, SO_PEERCRED, &who, &size) != 0) return {0, 0, -1};
  return {0, who.pid, static_cast<std::int64_t>(who.uid)};
}

/// As it is kept with a decision: "alice", "uid 1000", "the console, from 127.0.0.1".
std::string person(const ControlPeer& peer) {
  if (!peer.via.empty()) return peer.via;
  const passwd* const user = peer.uid < 0 ? nullptr : ::getpwuid(static_cast<uid_t>(peer.uid));
  return user == nullptr ? fmt::format("uid {}", peer.uid) : user->pw_name;
}

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
      const auto self = weak.lock();
      if (self == nullptr) return;
      const ControlPeer peer = peer_of(socket);
      self->admit(std::make_shared<LineConnection>(std::move(socket), kControlLineLimit), peer);
    });
    return {};
  }

  void stop() {
    listener_.reset();
    for (const auto& client : std::vector(clients_)) client->connection->close("the daemon is stopping");
  }

  [[nodiscard]] ControlStatus stats() const {
    ControlStatus out = counted_;
    out.clients = clients_.size();
    out.holder = lease_.holder(clock_.now().mono);
    return out;
  }

  void admit(const std::shared_ptr<Peer>& connection, ControlPeer peer) {
    peer.connection = next_connection_++;
    if (clients_.size() >= config_.max_clients) {
      ++counted_.refused;
      connection->send(
          refusal({ErrorCode::state,
                   fmt::format("{} control clients are connected, which is the limit", clients_.size()),
                   "end another mgt first"},
                  nullptr));
      return connection->close("too many clients");
    }
    ++counted_.accepted;
    const auto client =
        std::make_shared<Client>(Client{connection, peer, RequestRate(config_.rate, clock_.now().mono)});
    clients_.push_back(client);
    connection->start({.on_line = [this, client](std::string_view line) { on_line(*client, line); },
                       .on_overlong = [this, client] { on_overlong(*client); },
                       .refill = [](std::string&) {},
                       .keep_after_end = {},
                       .on_close = [this, client](std::string_view) { forget(client); }});
  }

 private:
  struct Client {
    std::shared_ptr<Peer> connection;
    ControlPeer peer;
    RequestRate rate;
  };

  void on_line(Client& client, std::string_view line) {
    const Stamp now = clock_.now();
    if (!client.rate.admit(now.mono)) {
      return drop(client, DropReason::too_often,
                  {ErrorCode::refused,
                   fmt::format("disconnected: more than {:g} requests a second", config_.rate.per_s),
                   "ask less often; what changes is told by the stream"});
    }
    auto request = parse_control(line);
    if (request && needs_control(request->command)) request->from = person(client.peer);
    client.connection->send(request ? encode_reply(request->id, answer(client.peer, *request, now)) + '\n'
                                    : refusal(request.error().error, request.error().id));
    if (client.connection->backlog() > kControlBacklog)
      drop(client, DropReason::unread, {ErrorCode::refused, "the client does not read its replies", ""});
  }

  Reply answer(const ControlPeer& peer, const ControlRequest& request, Stamp now) {
    if (auto mine = lease_.admit(peer, request.command, now); !mine) return tl::unexpected(mine.error());
    if (request.command == ControlCommand::control_take) {
      const auto wish = parse_take_request(request.args);
      if (!wish) return tl::unexpected(wish.error());
      const auto holder = lease_.take(peer, *wish, now);
      if (!holder) return tl::unexpected(holder.error());
      return to_json(std::optional(*holder));
    }
    if (request.command == ControlCommand::control_release) {
      if (auto done = lease_.release(peer, now.mono); !done) return tl::unexpected(done.error());
      return nlohmann::ordered_json::object();
    }
    if (request.command == ControlCommand::control_break) {
      const auto was = lease_.break_hold(now.mono);
      if (was)
        spdlog::warn("control was taken from {} by {}", name(ControlPeer{0, was->pid, was->uid, was->via}),
                     name(peer));
      return nlohmann::ordered_json{{"was", to_json(was)}};
    }
    return handler_(request);
  }

  void on_overlong(Client& client) {
    drop(client, DropReason::overlong,
         {ErrorCode::bad_input,
          fmt::format("disconnected: the request is longer than {} bytes", kControlLineLimit), ""});
  }

  void drop(Client& client, DropReason reason, const Error& why) {
    if (!client.connection->open()) return;
    counted_.drop(reason, fmt::format("{}: {}", name(client.peer), why.message));
    if (reason != DropReason::unread) client.connection->send(refusal(why, nullptr));
    client.connection->close(why.message);
  }

  void forget(const std::shared_ptr<Client>& client) {
    lease_.ended(client->peer.connection);
    std::erase(clients_, client);
  }

  boost::asio::io_context& io_;
  ControlConfig config_;
  Handler handler_;
  drivers::Clock clock_;  ///< people wait in real time, however fast the rig's runs
  ControlLease lease_;
  ControlStatus counted_;
  std::uint64_t next_connection_{1};
  std::optional<Listener> listener_;
  std::vector<std::shared_ptr<Client>> clients_;
};

ControlServer::ControlServer(boost::asio::io_context& io, ControlConfig config, Handler handler)
    : state_(std::make_shared<State>(io, std::move(config), std::move(handler))) {}
ControlServer::~ControlServer() { state_->stop(); }
Result<void> ControlServer::start() { return state_->start(); }
void ControlServer::stop() { state_->stop(); }
void ControlServer::admit(const std::shared_ptr<Peer>& peer, std::string via) {
  state_->admit(peer, {0, 0, -1, std::move(via)});
}
ControlStatus ControlServer::stats() const { return state_->stats(); }

}  // namespace mgtd::daemon::serve
