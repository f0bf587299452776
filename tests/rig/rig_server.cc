// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/rig_server.h"

#include <fmt/format.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/streambuf.hpp>
#include <boost/asio/write.hpp>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <istream>
#include <sstream>

#include "proto/standard_output.h"
#include "tests/rig/bench_rig.h"
#include "tests/rig/fault_client.h"
#include "tests/rig/pty.h"

namespace mgtd::rig {
namespace {

namespace asio = boost::asio;
using local = asio::local::stream_protocol;
constexpr auto kTick = std::chrono::milliseconds(1);
/// What a host that does not read may leave in the cable before bytes are lost, as on a real one, in real
/// time.
constexpr double kMaxBacklog = 16384;

double utc_now_s() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

class Server {
 public:
  Server(asio::io_context& io, Scenario scenario, ServerOptions options)
      : io_(io),
        options_(std::move(options)),
        rig_(std::move(scenario), utc_now_s()),
        timer_(io),
        acceptor_(io),
        signals_(io, SIGINT, SIGTERM) {}

  /// Empty when all went well, else what did not.
  [[nodiscard]] std::string start();
  void clean_up();

 private:
  [[nodiscard]] double now_s() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count() *
           options_.speed_up;
  }
  [[nodiscard]] std::string open_ports();
  [[nodiscard]] std::string open_socket();
  void tick();
  void serve_port(std::size_t i, double now);
  void accept();
  void answer(const std::shared_ptr<local::socket>& socket);
  [[nodiscard]] std::string reply_to(const std::string& line);
  bool magnet(const std::string& line);
  [[nodiscard]] std::string status() const;
  [[nodiscard]] std::string field() const;

  asio::io_context& io_;
  ServerOptions options_;
  std::chrono::steady_clock::time_point start_{std::chrono::steady_clock::now()};
  BenchRig rig_;
  std::vector<std::unique_ptr<Pty>> ports_;
  std::vector<std::string> backlog_;
  std::vector<std::uint64_t> unplugged_;  ///< times
  asio::steady_timer timer_;
  local::acceptor acceptor_;
  asio::signal_set signals_;
  bool own_socket_{false};
};

std::string Server::open_ports() {
  std::error_code ec;
  std::filesystem::create_directories(options_.dir, ec);
  if (ec) return fmt::format("{}: {}", options_.dir, ec.message());
  for (std::size_t i = 0; i < rig_.ports(); ++i) {
    ports_.push_back(std::make_unique<Pty>(fmt::format("{}/{}", options_.dir, rig_.name(i))));
    if (!ports_.back()->is_open()) return ports_.back()->why();
  }
  backlog_.resize(ports_.size());
  unplugged_.resize(ports_.size());
  return {};
}

std::string Server::open_socket() {
  const std::string path = fault_socket(options_.dir);
  if (path.size() > 107) return fmt::format("{}: too long for a socket; choose a shorter --dir", path);
  std::error_code ignored;
  std::filesystem::remove(path, ignored);
  boost::system::error_code ec;
  acceptor_.open(local(), ec);
  if (!ec) acceptor_.bind(local::endpoint(path), ec);
  own_socket_ = !ec;
  if (!ec) acceptor_.listen(4, ec);
  return ec ? fmt::format("{}: {}", path, ec.message()) : std::string();
}

std::string Server::start() {
  if (ask_rig(options_.dir, "status"))
    return fmt::format("a rig is already running in {}; stop it or choose another --dir", options_.dir);
  if (std::string why = open_ports(); !why.empty()) return why;
  if (std::string why = open_socket(); !why.empty()) return why;
  signals_.async_wait([this](auto, int) { io_.stop(); });
  accept();
  tick();
  std::ofstream(options_.dir + "/ready") << getpid() << "\n";
  fmt::print("ready: {} ports in {}, {} times real time\n", ports_.size(), options_.dir, options_.speed_up);
  flush_standard_output();
  return {};
}

void Server::clean_up() {
  ports_.clear();
  std::error_code ignored;
  if (!own_socket_) return;
  std::filesystem::remove(options_.dir + "/ready", ignored);
  std::filesystem::remove(fault_socket(options_.dir), ignored);
}

void Server::tick() {
  const double now = now_s();
  rig_.run_script(now);
  for (std::size_t i = 0; i < ports_.size(); ++i) serve_port(i, now);
  timer_.expires_after(kTick);
  timer_.async_wait([this](auto ec) {
    if (!ec) tick();
  });
}

void Server::serve_port(std::size_t i, double now) {
  Pty& pty = *ports_[i];
  std::string& waiting = backlog_[i];
  const bool replugged = std::exchange(unplugged_[i], rig_.unplugged(i)) != rig_.unplugged(i);
  if (pty.is_open() && (!rig_.plugged(i) || replugged)) pty.close();
  if (rig_.plugged(i) && !pty.is_open()) pty.open();
  rig_.write(i, pty.read(), now);
  if (!pty.listened()) {
    waiting.clear();
    return rig_.drop(i, now);
  }
  waiting += rig_.read(i, now);
  waiting.erase(0, pty.write(waiting));
  // A pause of the host holds as many more bytes as time runs faster.
  const auto limit = static_cast<std::size_t>(kMaxBacklog * std::max(1.0, options_.speed_up));
  if (waiting.size() > limit) waiting.erase(0, waiting.size() - limit);
}

void Server::accept() {
  acceptor_.async_accept([this](boost::system::error_code ec, local::socket socket) {
    if (ec) return;
    answer(std::make_shared<local::socket>(std::move(socket)));
    accept();
  });
}

void Server::answer(const std::shared_ptr<local::socket>& socket) {
  auto buffer = std::make_shared<asio::streambuf>(1024);
  asio::async_read_until(*socket, *buffer, '\n', [this, socket, buffer](auto ec, std::size_t) {
    if (ec) return;
    std::istream in(buffer.get());
    std::string line;
    std::getline(in, line);
    auto reply = std::make_shared<std::string>(reply_to(line) + "\n");
    asio::async_write(*socket, asio::buffer(*reply), [socket, reply](auto, std::size_t) {});
  });
}

std::string Server::reply_to(const std::string& line) {
  if (line == "status") return status();
  if (line == "field") return field();
  if (rig_.mount(line, now_s()) || rig_.surroundings(line, now_s()) || magnet(line)) return "ok";
  if (line.starts_with("magnet "))
    return fmt::format("this array has the sensors 1 to {}, and 0 puts the magnet away",
                       rig_.world().sensors());
  const auto fault = parse_fault(line, rig_.world().sensors());
  if (!fault) return fault.error();
  const auto applied = rig_.apply(*fault, now_s());
  return applied ? "ok" : applied.error();
}

/// "magnet ARM": held to the end of that arm; 0: put away. False: that is something else.
bool Server::magnet(const std::string& line) {
  std::istringstream in(line);
  std::string word;
  int arm = -1;
  if (!(in >> word >> arm) || word != "magnet" || arm < 0 || arm > static_cast<int>(rig_.world().sensors()))
    return false;
  rig_.world().hold_magnet(arm);
  return true;
}

/// The answer that a daemon on this rig should stream.
std::string Server::field() const {
  const double now = now_s();
  static constexpr std::array<const char*, 6> kNames{"xx", "yy", "zz", "xy", "xz", "yz"};
  const auto values = rig_.world().true_gradient_nT_per_m(now);
  nlohmann::ordered_json g;
  for (std::size_t i = 0; i < values.size(); ++i) g[kNames[i]] = values[i];
  return nlohmann::ordered_json{{"schema", "mgt-rig.field/1"}, {"t_s", now}, {"g_nT_per_m", g}}.dump();
}

std::string Server::status() const {
  const double now = now_s();
  nlohmann::json ports;
  for (std::size_t i = 0; i < ports_.size(); ++i)
    ports[std::string(rig_.name(i))] = {{"plugged", rig_.plugged(i)},
                                        {"instrument", rig_.instrument(i)},
                                        {"listened", ports_[i]->listened()}};
  nlohmann::json angles;
  for (const TableAxis axis : {azimuth, pitch, roll})
    angles.push_back(rig_.world().axis(axis).indicated_deg(now));
  return nlohmann::json{{"schema", "mgt-rig.status/1"},
                        {"scenario", rig_.world().scenario().name},
                        {"t_s", now},
                        {"speed_up", options_.speed_up},
                        {"ports", ports},
                        {"table_deg", angles},
                        {"moving", rig_.world().moving(now)}}
      .dump();
}

}  // namespace

int serve(Scenario scenario, const ServerOptions& options) {
  std::signal(SIGPIPE, SIG_IGN);
  asio::io_context io(1);
  Server server(io, std::move(scenario), options);
  const std::string why = server.start();
  if (why.empty()) {
    io.run();
  } else {
    fmt::print(stderr, "mgt-rig: {}\n", why);
  }
  server.clean_up();
  return why.empty() ? 0 : 2;
}

}  // namespace mgtd::rig
