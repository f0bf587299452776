// SPDX-License-Identifier: Apache-2.0
#include "daemon/serve/stream_server.h"

#include <fmt/format.h>

#include <boost/asio/post.hpp>
#include <vector>

#include "daemon/serve/line_connection.h"
#include "daemon/serve/listener.h"
#include "daemon/serve/sample_ring.h"
#include "daemon/serve/subscription.h"
#include "drivers/clock.h"
#include "proto/tensor_encoder.h"
#include "proto/watch_request.h"

namespace mgtd::daemon::serve {
namespace {

constexpr int kBadLines = 32;                            // in a row, before a client counts as flooding
constexpr std::size_t kStreamReplyBacklog = 256 * 1024;  // bytes of replies a client may leave unread
constexpr std::size_t kBatch = LineConnection::kBatch;   // bytes written to a client in one turn

Error overlong() {
  return {ErrorCode::bad_input,
          fmt::format("the line is longer than {} bytes and was dropped", kWatchLineLimit),
          "send one short object per line"};
}

}  // namespace

class StreamServer::State : public std::enable_shared_from_this<State> {
 public:
  State(boost::asio::io_context& io, StreamConfig config, const Greeting& greeting)
      : io_(io), config_(std::move(config)), greeting_(encode(greeting) + '\n'), ring_(config_.ring_lines) {}

  Result<void> start();
  void stop();
  void admit(const std::shared_ptr<Peer>& connection);

  void keep(store::DiskRing& disk) {
    disk_ = &disk;
    const auto& between = disk.between();
    ring_ = SampleRing(config_.ring_lines, between ? between->from_seq : disk.first_seq());
    if (between) publish(*between);
  }
  void publish(const TensorSample& sample, std::span<const InputValue> inputs) {
    const std::string_view line = encoder_.encode(sample, inputs);
    ring_.push_sample(sample.seq, sample.t.mono, line);
    if (disk_ != nullptr) disk_->push({RingRecord::Kind::sample, sample.seq, sample.seq, sample.t, line});
    serve_later();
  }
  void publish(const Gap& gap) {
    const std::string line = encode(gap);
    ring_.push_gap(gap.from_seq, gap.to_seq, line);
    if (disk_ != nullptr) disk_->push({RingRecord::Kind::gap, gap.from_seq, gap.to_seq, gap.at, line});
    serve_later();
  }
  void publish_line(StreamClass stream_class, std::string_view line) {
    ring_.push_other(stream_class, line);
    serve_later();
  }

  [[nodiscard]] StreamStatus stats() const {
    StreamStatus status = counted_;
    status.clients = clients_.size();
    return status;
  }
  [[nodiscard]] std::uint16_t tcp_port() const { return tcp_port_; }

 private:
  struct Client {
    std::shared_ptr<Peer> connection;
    RequestRate rate;
    Subscription subscription{};
    std::optional<store::RingReader> past{};  ///< while it reads what is on disk
    int bad_lines{0};
  };

  void on_line(Client& client, std::string_view line);
  void bad_line(Client& client, const Error& error);
  void refill(Client& client, std::string& out);
  void read_past(Client& client, std::string& out);
  void serve_later();
  void serve();
  void drop(Client& client, DropReason reason, const Error& why);

  boost::asio::io_context& io_;
  StreamConfig config_;
  std::string greeting_;
  SampleRing ring_;
  store::DiskRing* disk_{nullptr};
  TensorEncoder encoder_;
  std::vector<Listener> listeners_;
  std::uint16_t tcp_port_{0};
  std::vector<std::shared_ptr<Client>> clients_;
  StreamStatus counted_;
  drivers::Clock clock_;
  bool serving_{false};  ///< serve() is queued
};

Result<void> StreamServer::State::start() {
  std::vector<Listener> listeners;
  if (!config_.tcp.empty()) {
    auto tcp = Listener::tcp(io_, config_.tcp);
    if (!tcp) return tl::unexpected(tcp.error());
    listeners.push_back(std::move(*tcp));
    tcp_port_ = listeners.back().port();
  }
  if (!config_.unix_path.empty()) {
    auto file = Listener::unix_socket(io_, config_.unix_path, config_.unix_mode);
    if (!file) return tl::unexpected(file.error());
    listeners.push_back(std::move(*file));
  }
  listeners_ = std::move(listeners);
  for (Listener& listener : listeners_) {
    listener.start([weak = weak_from_this()](LineConnection::Socket socket) {
      if (const auto self = weak.lock())
        self->admit(std::make_shared<LineConnection>(std::move(socket), kWatchLineLimit));
    });
  }
  return {};
}

void StreamServer::State::stop() {
  listeners_.clear();
  const std::string goodbye =
      encode(Error{ErrorCode::state, "the daemon is stopping", "connect again when it runs"}) + '\n';
  for (const auto& client : std::vector(clients_)) {
    client->connection->send(goodbye);
    client->connection->close("the daemon is stopping");
  }
}

void StreamServer::State::admit(const std::shared_ptr<Peer>& connection) {
  if (clients_.size() >= config_.max_clients) {
    ++counted_.refused;
    connection->send(
        encode(Error{ErrorCode::refused,
                     fmt::format("{} clients are connected, which is the limit", clients_.size()),
                     "disconnect one, or raise the limit in the configuration"}) +
        '\n');
    return connection->close("too many clients");
  }
  ++counted_.accepted;
  const auto client =
      std::make_shared<Client>(Client{connection, RequestRate(config_.rate, clock_.now().mono)});
  clients_.push_back(client);
  // The connection is closed, and these handlers gone, before the server is.
  connection->start({.on_line = [this, client](std::string_view line) { on_line(*client, line); },
                     .on_overlong = [this, client] { bad_line(*client, overlong()); },
                     .refill = [this, client](std::string& out) { refill(*client, out); },
                     .keep_after_end = [client] { return client->subscription.watching(); },
                     .on_close = [this, client](std::string_view) { std::erase(clients_, client); }});
  connection->send(greeting_);
}

void StreamServer::State::on_line(Client& client, std::string_view line) {
  if (!client.rate.admit(clock_.now().mono)) {
    return drop(
        client, DropReason::too_often,
        {ErrorCode::refused, fmt::format("disconnected: more than {:g} lines a second", config_.rate.per_s),
         "send one watch and read"});
  }
  const auto request = parse_watch(line);
  if (!request) return bad_line(client, request.error());
  client.bad_lines = 0;
  std::string out;
  const bool goes_back = disk_ != nullptr && request->from_seq;
  client.subscription.watch(*request, ring_, out, goes_back ? disk_->oldest_seq() : std::nullopt);
  client.past.reset();
  if (const auto seq = client.subscription.behind()) client.past = disk_->read_from(*seq);
  client.connection->send(out);
  if (client.connection->backlog() > kStreamReplyBacklog) {
    return drop(client, DropReason::unread,
                {ErrorCode::refused, "the client asks and does not read the answers", ""});
  }
  serve_later();
}

void StreamServer::State::bad_line(Client& client, const Error& error) {
  client.connection->send(encode(error) + '\n');
  if (++client.bad_lines < kBadLines && client.connection->backlog() <= kStreamReplyBacklog) return;
  drop(client, DropReason::bad_lines,
       {ErrorCode::refused, fmt::format("disconnected: {} bad lines in a row", client.bad_lines),
        "see the errors before this one"});
}

void StreamServer::State::refill(Client& client, std::string& out) {
  const std::uint64_t before = client.subscription.gaps();
  if (client.past) read_past(client, out);
  if (!client.past) client.subscription.fill(ring_, out, kBatch);
  counted_.gaps += client.subscription.gaps() - before;
}

/// A piece of the disk per turn: nobody waits long.
void StreamServer::State::read_past(Client& client, std::string& out) {
  Subscription& subscription = client.subscription;
  const bool more = client.past->read([&](const RingRecord& record) {
    if (subscription.behind()) subscription.take(record, ring_, out);
  });
  if (!more && subscription.behind()) subscription.catch_up(ring_, out);
  if (!subscription.behind()) client.past.reset();
  serve_later();
}

void StreamServer::State::drop(Client& client, DropReason reason, const Error& why) {
  if (!client.connection->open()) return;
  counted_.drop(reason, why.message);
  if (client.connection->backlog() == 0) client.connection->send(encode(why) + '\n');
  client.connection->close(why.message);
}

void StreamServer::State::serve_later() {
  if (serving_ || clients_.empty()) return;
  serving_ = true;
  boost::asio::post(io_, [weak = weak_from_this()] {
    if (const auto self = weak.lock()) self->serve();
  });
}

void StreamServer::State::serve() {
  serving_ = false;
  for (std::size_t i = clients_.size(); i-- > 0;) {  // a client that closes takes only itself out
    const auto client = clients_[i];
    if (client->subscription.stays_behind(ring_)) {
      drop(*client, DropReason::behind,
           {ErrorCode::refused, "disconnected: the client stayed behind the stream",
            "read faster, or ask for fewer samples with rate_hz"});
    } else {
      client->connection->flush();
    }
  }
}

StreamServer::StreamServer(boost::asio::io_context& io, StreamConfig config, Greeting greeting)
    : state_(std::make_shared<State>(io, std::move(config), greeting)) {}
StreamServer::~StreamServer() { state_->stop(); }

void StreamServer::keep(store::DiskRing& disk) { state_->keep(disk); }
Result<void> StreamServer::start() { return state_->start(); }
void StreamServer::stop() { state_->stop(); }
void StreamServer::admit(const std::shared_ptr<Peer>& peer) { state_->admit(peer); }
void StreamServer::publish(const TensorSample& sample, std::span<const InputValue> inputs) {
  state_->publish(sample, inputs);
}
void StreamServer::publish(const Gap& gap) { state_->publish(gap); }
void StreamServer::publish(const StatusReport& report) {
  state_->publish_line(StreamClass::status, encode(report));
}
void StreamServer::publish(const RunStatus& run) { state_->publish_line(StreamClass::run, encode(run)); }
void StreamServer::publish(const SensorsReport& sensors) {
  state_->publish_line(StreamClass::sensors, encode(sensors));
}
void StreamServer::publish_line(StreamClass stream_class, std::string_view line) {
  state_->publish_line(stream_class, line);
}
StreamStatus StreamServer::stats() const { return state_->stats(); }
std::uint16_t StreamServer::tcp_port() const { return state_->tcp_port(); }

}  // namespace mgtd::daemon::serve
