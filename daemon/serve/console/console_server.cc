// SPDX-License-Identifier: Apache-2.0
#include "daemon/serve/console/console_server.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/http.hpp>
#include <chrono>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "daemon/config/tcp_address.h"
#include "daemon/serve/console/host_rule.h"
#include "daemon/serve/console/http_message.h"
#include "daemon/serve/console/page_files.h"
#include "daemon/serve/console/refusals.h"
#include "daemon/serve/console/web_peer.h"
#include "daemon/serve/listener.h"
#include "drivers/clock.h"
#include "proto/control_codec.h"
#include "proto/watch_request.h"

namespace mgtd::daemon::serve::console {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using boost::system::error_code;
using Stream = beast::basic_stream<asio::generic::stream_protocol>;

namespace {

constexpr std::uint32_t kHeadLimit = 8'192;
constexpr std::size_t kTokenLine = 256;
constexpr std::uint64_t kBodyLimit = 65'536, kLongAnswer = 1'000'000;

/// Where a peer is; empty where the kernel does not say.
std::optional<asio::ip::address> address_of(Listener::Socket& socket) {
  error_code ec;
  const auto endpoint = socket.remote_endpoint(ec);
  if (ec) return std::nullopt;
  asio::ip::tcp::endpoint tcp;
  if (endpoint.size() > tcp.capacity()) return std::nullopt;
  std::memcpy(tcp.data(), endpoint.data(), endpoint.size());
  tcp.resize(endpoint.size());
  return tcp.address();
}

}  // namespace

class ConsoleServer::State : public std::enable_shared_from_this<State> {
 public:
  State(asio::io_context& io, ConsoleConfig config, ConsoleSource source)
      : io_(io),
        config_(std::move(config)),
        source_(std::move(source)),
        rate_(config_.rate, clock_.now().mono) {
    if (config_.workbench) desk_.emplace(io_, *config_.workbench);
  }

  Result<void> start();
  void stop();
  [[nodiscard]] std::string address() const { return address_; }
  [[nodiscard]] const ConsoleToken& token() const { return token_; }
  [[nodiscard]] std::uint64_t refused() const { return refusals_.total(); }

 private:
  class Session;
  void admit(Listener::Socket socket);
  /// `who`: for people, where the request came from.
  [[nodiscard]] Response answered(const Request& request, const std::string& who);
  [[nodiscard]] Response content(const Request& request, std::string_view target);
  [[nodiscard]] Result<void> may_come(const Request& request);
  [[nodiscard]] Response of_job(const Request& request, const std::string& who);

  asio::io_context& io_;
  ConsoleConfig config_;
  ConsoleSource source_;
  drivers::Clock clock_;
  RequestRate rate_;
  ConsoleToken token_{ConsoleToken::random()};
  Refusals refusals_;
  std::optional<HostRule> rule_;
  std::optional<Listener> listener_;
  std::optional<JobDesk> desk_;
  std::string address_;
  std::set<std::shared_ptr<Session>> sessions_;
};

/// One connection: requests one after the other, until it closes or becomes a WebSocket.
class ConsoleServer::State::Session : public std::enable_shared_from_this<Session> {
 public:
  Session(std::shared_ptr<State> server, Listener::Socket socket)
      : server_(std::move(server)), from_(address_of(socket)), stream_(std::move(socket)) {}

  void read() {
    parser_.emplace();
    parser_->header_limit(kHeadLimit);
    parser_->body_limit(kBodyLimit);
    stream_.expires_after(server_->config_.patience);  // of the whole request, however its bytes dribble
    http::async_read_header(stream_, buffer_, *parser_,
                            [self = shared_from_this()](error_code ec, std::size_t) {
                              if (ec) return self->read_failed(ec);
                              self->read_body();
                            });
  }
  void close() {
    if (web_) return gone();
    stream_.close();
    server_->sessions_.erase(shared_from_this());
  }

 private:
  void read_failed(error_code ec) {
    if (ec == http::error::header_limit || ec == http::error::body_limit ||
        ec == http::error::buffer_overflow) {
      Response response{http::status::payload_too_large, 11};
      response.body() =
          in_json({ErrorCode::bad_input,
                   "a request has at most 8 kB and no body; a job has a body of at most 64 kB", ""});
      return answer(std::move(response), "", false);
    }
    close();
  }

  /// Only a job has one, and whoever asks for it is known by then.
  void read_body() {
    if (parser_->is_done()) return act(parser_->release());
    const Request& head = parser_->get();
    if (!asks_for_job(head) || !server_->desk_) return read_failed(http::error::body_limit);
    if (auto allowed = may_ask_for_jobs(head); !allowed) return refuse_job(head, allowed.error());
    http::async_read(stream_, buffer_, *parser_, [self = shared_from_this()](error_code ec, std::size_t) {
      if (ec) return self->read_failed(ec);
      self->act(self->parser_->release());
    });
  }

  void act(Request request) {
    const std::string host(field(request, "Host").value_or(""));
    if (beast::websocket::is_upgrade(request)) {
      const std::string target(request.target().data(), request.target().size());
      auto allowed = server_->may_come(request);
      if (allowed && target == "/control") {
        allowed = may_control();
        if (!allowed) note_refusal(allowed.error());
      }
      if (!allowed) return answer(refusal(request, allowed.error()), host, false);
      if ((target == "/stream" && server_->source_.stream) ||
          (target == "/control" && server_->source_.control))
        return upgrade(std::move(request), target == "/control");
    }
    const bool keep_alive = request.keep_alive();
    if (asks_for_job(request) && server_->desk_) {
      if (auto allowed = may_ask_for_jobs(request); !allowed) return refuse_job(request, allowed.error());
    }
    answer(server_->answered(request, who()), host, keep_alive);
  }

  [[nodiscard]] Result<void> may_ask_for_jobs(const Request& request) const {
    constexpr std::string_view kBearer = "Bearer ";
    if (auto allowed = server_->may_come(request); !allowed) return allowed;
    if (auto allowed = may_control(); !allowed) return allowed;
    const std::string_view offered = field(request, "Authorization").value_or("");
    if (offered.starts_with(kBearer) && server_->token_.is(offered.substr(kBearer.size()))) return {};
    return fail(ErrorCode::refused, "computing needs the token, which is new at every start",
                "open the address that mgt console or mgt serve prints");
  }

  /// Late, so that guessing takes long.
  void refuse_job(const Request& request, const Error& why) {
    note_refusal(why);
    response_ = refusal(request, why);
    timer_.emplace(stream_.get_executor(), server_->config_.wrong_token_wait);
    timer_->async_wait(
        [self = shared_from_this()](error_code) { self->answer(std::move(self->response_), "", false); });
  }

  [[nodiscard]] std::string who() const {
    return "the console, from " + (from_ ? from_->to_string() : std::string("this computer"));
  }

  void note_refusal(const Error& why) {
    const auto line = server_->refusals_.add(from_ ? from_->to_string() : "an unknown place", why.message,
                                             server_->clock_.now().mono);
    if (line) spdlog::warn("{}", *line);
  }

  [[nodiscard]] Result<void> may_control() const {
    if (server_->config_.control_from_network || (from_ && from_->is_loopback())) return {};
    return fail(
        ErrorCode::refused, "control is for browsers on the rig's computer",
        "open a tunnel (ssh -L 7451:127.0.0.1:7451 RIG), or set control_from = \"network\" in [console]");
  }

  void answer(Response response, const std::string& host, bool keep_alive) {
    forbid_all_else(response, host);
    response.keep_alive(keep_alive);
    response.prepare_payload();
    if (response.body().size() > kLongAnswer) stream_.expires_after(6 * server_->config_.patience);
    response_ = std::move(response);
    http::async_write(stream_, response_,
                      [self = shared_from_this(), keep_alive](error_code ec, std::size_t) {
                        if (ec || !keep_alive) return self->close();
                        self->read();
                      });
  }

  void upgrade(Request request, bool control) {
    web_.emplace(std::move(stream_));
    web_->set_option(beast::websocket::stream_base::timeout::suggested(beast::role_type::server));
    request_ = std::move(request);
    beast::get_lowest_layer(*web_).expires_after(server_->config_.patience);
    web_->async_accept(request_, [self = shared_from_this(), control](error_code ec) {
      if (ec) return self->gone();
      if (control) return self->read_token();
      self->server_->source_.stream(self->handed_over(kWatchLineLimit));
    });
  }

  /// The first line of /control.
  void read_token() {
    web_->read_message_max(kTokenLine);
    web_->async_read(buffer_, [self = shared_from_this()](error_code ec, std::size_t) {
      if (ec) return self->gone();
      const auto line = nlohmann::json::parse(beast::buffers_to_string(self->buffer_.data()), nullptr, false);
      self->buffer_.consume(self->buffer_.size());
      const bool right = line.is_object() && line.contains("token") && line["token"].is_string() &&
                         self->server_->token_.is(line["token"].get_ref<const std::string&>());
      if (!right) return self->refuse_token();
      self->server_->source_.control(self->handed_over(kControlLineLimit), self->who());
    });
  }

  /// Late, so that guessing takes long.
  void refuse_token() {
    const Error why{ErrorCode::refused, "the token is wrong: it is new at every start",
                    "open the address that mgt console prints"};
    note_refusal(why);
    text_ = encode_reply(nullptr, tl::unexpected(why)) + '\n';
    timer_.emplace(web_->get_executor(), server_->config_.wrong_token_wait);
    timer_->async_wait([self = shared_from_this()](error_code) {
      self->web_->text(true);
      self->web_->async_write(asio::buffer(self->text_), [self](error_code, std::size_t) { self->gone(); });
    });
  }

  /// The WebSocket belongs to whoever feeds it from here on.
  [[nodiscard]] std::shared_ptr<WebPeer> handed_over(std::size_t line_limit) {
    beast::get_lowest_layer(*web_).expires_never();
    auto peer = std::make_shared<WebPeer>(std::move(*web_), line_limit);
    web_.reset();
    server_->sessions_.erase(shared_from_this());
    return peer;
  }

  void gone() {
    if (web_) beast::get_lowest_layer(*web_).close();
    server_->sessions_.erase(shared_from_this());
  }

  std::shared_ptr<State> server_;
  std::optional<asio::ip::address> from_;
  Stream stream_;
  beast::flat_buffer buffer_{kHeadLimit + 1024};
  std::optional<http::request_parser<http::string_body>> parser_;
  Response response_;
  Request request_;
  std::optional<WebStream> web_;
  std::optional<asio::steady_timer> timer_;
  std::string text_;
};

Result<void> ConsoleServer::State::start() {
  if (config_.listen.empty()) return {};
  auto listener = Listener::tcp(io_, config_.listen);
  if (!listener) return tl::unexpected(listener.error());
  const auto endpoint = config::parse_tcp_address(config_.listen);
  std::vector<std::string> names = config_.hosts;
  const std::string host = config_.listen.substr(0, config_.listen.rfind(':'));
  if (endpoint && !endpoint->address().is_unspecified()) names.push_back(host);
  rule_.emplace(listener->port(), names);
  address_ = fmt::format("http://{}:{}/",
                         endpoint && endpoint->address().is_unspecified() ? std::string("127.0.0.1") : host,
                         listener->port());
  listener_ = std::move(*listener);
  listener_->start([weak = weak_from_this()](Listener::Socket socket) {
    if (const auto self = weak.lock()) self->admit(std::move(socket));
  });
  return {};
}

void ConsoleServer::State::stop() {
  listener_.reset();
  address_.clear();
  if (desk_) desk_->stop();
  for (const auto& session : std::set(sessions_)) session->close();
}

void ConsoleServer::State::admit(Listener::Socket socket) {
  if (sessions_.size() >= config_.max_connections) return;  // closed by going out of scope
  const auto session = std::make_shared<Session>(shared_from_this(), std::move(socket));
  sessions_.insert(session);
  session->read();
}

Result<void> ConsoleServer::State::may_come(const Request& request) { return rule_->admit(head_of(request)); }

Response ConsoleServer::State::answered(const Request& request, const std::string& who) {
  if (!rate_.admit(clock_.now().mono)) {
    Response later = refusal(request, {ErrorCode::refused, "too many requests a second", "ask less often"},
                             http::status::too_many_requests);
    later.set(http::field::retry_after, "1");
    return later;
  }
  if (auto allowed = may_come(request); !allowed) return refusal(request, allowed.error());
  if (asks_for_job(request) && desk_) return of_job(request, who);
  if (request.method() != http::verb::get)
    return refusal(request, {ErrorCode::bad_input, "only GET is answered", ""},
                   http::status::method_not_allowed);
  return content(request, {request.target().data(), request.target().size()});
}

Response ConsoleServer::State::of_job(const Request& request, const std::string& who) {
  JobAnswer given = desk_->answer({request.method_string().data(), request.method_string().size()},
                                  path_of(request), request.body(), who);
  Response response{static_cast<http::status>(given.status), request.version()};
  response.set(http::field::content_type, given.type);
  response.body() = std::move(given.body);
  return response;
}

Response ConsoleServer::State::content(const Request& request, std::string_view target) {
  const std::string_view path = target.substr(0, target.find('?'));
  const std::string_view query =
      path.size() < target.size() ? target.substr(path.size() + 1) : std::string_view();
  Response response{http::status::ok, request.version()};
  const auto with = [&](std::string_view type, std::string body) {
    response.set(http::field::content_type, beast::string_view(type.data(), type.size()));
    response.body() = std::move(body);
    return response;
  };
  constexpr std::string_view kJson = "application/json", kPages = "/page/";
  if (path == "/api/hello") return with(kJson, source_.hello());
  if (path == "/runs" && desk_) return with(kJson, desk_->runs());
  if (path == "/metrics" && source_.metrics) return with("text/plain; version=0.0.4", source_.metrics());
  if (path == "/run/course" && source_.course) return with(kJson, source_.course());
  const auto with_result = [&](Result<std::string> answer, http::status otherwise) {
    if (answer) return with(kJson, *std::move(answer));
    response.result(otherwise);
    return with(kJson, in_json(answer.error()));
  };
  if (path == "/run/events" && source_.events)
    return with_result(source_.events(), http::status::internal_server_error);
  if (path == "/lane" && source_.lane) return with_result(source_.lane(query), http::status::bad_request);
  const std::string_view name = path == "/"                ? std::string_view("index.html")
                                : path.starts_with(kPages) ? path.substr(kPages.size())
                                                           : std::string_view();
  if (const auto file = page_file(name)) return with(file->type, std::string(file->bytes));
  response.result(http::status::not_found);
  return with(kJson, in_json({ErrorCode::bad_input, "there is nothing at this address", "the page is at /"}));
}

ConsoleServer::ConsoleServer(asio::io_context& io, ConsoleConfig config, ConsoleSource source)
    : state_(std::make_shared<State>(io, std::move(config), std::move(source))) {}
ConsoleServer::~ConsoleServer() { state_->stop(); }
Result<void> ConsoleServer::start() { return state_->start(); }
void ConsoleServer::stop() { state_->stop(); }
std::string ConsoleServer::address() const { return state_->address(); }
const ConsoleToken& ConsoleServer::token() const { return state_->token(); }
std::uint64_t ConsoleServer::refused() const { return state_->refused(); }

}  // namespace mgtd::daemon::serve::console
