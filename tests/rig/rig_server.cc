// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/rig_server.h"

#include <fmt/format.h>
#include <unistd.h>

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

#include "tests/rig/bench_rig.h"
#include "tests/rig/pty.h"

namespace mgtd::rig {
namespace {

namespace asio = boost::asio;
using local = asio::local::stream_protocol;
constexpr auto kTick = std::chrono::milliseconds(1);
/// What a host that does not read may leave in the cable before bytes are lost, as on a real one.
constexpr std::size_t kMaxBacklog = 16384;

std::string fault_socket(const std::string& dir) { return dir + "/fault.sock"; }

class Server {
 public:
  Server(asio::io_context& io, Scenario scenario, ServerOptions options)
      : options_(std::move(options)),
        rig_(std::move(scenario), utc_now()),
        timer_(io),
        acceptor_(io),
        signals_(io, SIGINT, SIGTERM) {}

  bool start() {
    std::error_code ignored;
    std::filesystem::create_directories(options_.dir, ignored);
    for (std::size_t i = 0; i < rig_.ports(); ++i) {
      ports_.push_back(std::make_unique<Pty>(options_.dir + "/" + std::string(kPortNames.at(i))));
      if (!ports_.back()->is_open()) {
        fmt::print(stderr, "mgt-rig: {}\n", ports_.back()->why());
        return false;
      }
    }
    backlog_.resize(ports_.size());
    std::filesystem::remove(fault_socket(options_.dir), ignored);
    boost::system::error_code ec;
    acceptor_.open(local(), ec);
    acceptor_.bind(local::endpoint(fault_socket(options_.dir)), ec);
    acceptor_.listen(4, ec);
    if (ec) {
      fmt::print(stderr, "mgt-rig: {}: {}\n", fault_socket(options_.dir), ec.message());
      return false;
    }
    signals_.async_wait([this](auto, int) { stop(); });
    accept();
    tick();
    std::ofstream(options_.dir + "/ready") << getpid() << "\n";
    fmt::print("ready: {} ports in {}, {} times real time\n", ports_.size(), options_.dir, options_.speed_up);
    std::fflush(stdout);
    return true;
  }

  void clean_up() {
    ports_.clear();
    std::error_code ignored;
    std::filesystem::remove(options_.dir + "/ready", ignored);
    std::filesystem::remove(fault_socket(options_.dir), ignored);
  }

 private:
  static double utc_now() {
    return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
  }
  [[nodiscard]] double now_s() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count() *
           options_.speed_up;
  }

  void stop() {
    boost::system::error_code ignored;
    timer_.cancel();
    acceptor_.close(ignored);
    stopping_ = true;
  }

  void tick() {
    const double now = now_s();
    rig_.run_script(now);
    for (std::size_t i = 0; i < ports_.size(); ++i) serve_port(i, now);
    if (stopping_) return;
    timer_.expires_after(kTick);
    timer_.async_wait([this](auto ec) {
      if (!ec && !stopping_) tick();
    });
  }

  void serve_port(std::size_t i, double now) {
    Pty& pty = *ports_[i];
    if (rig_.plugged(i) && !pty.is_open()) pty.open();
    if (!rig_.plugged(i) && pty.is_open()) {
      pty.close();
      backlog_[i].clear();
    }
    rig_.write(i, pty.read(), now);
    std::string& waiting = backlog_[i];
    waiting += rig_.read(i, now);
    waiting.erase(0, pty.write(waiting));
    if (waiting.size() > kMaxBacklog) waiting.erase(0, waiting.size() - kMaxBacklog);
  }

  void accept() {
    acceptor_.async_accept([this](boost::system::error_code ec, local::socket socket) {
      if (ec) return;
      answer(std::make_shared<local::socket>(std::move(socket)));
      accept();
    });
  }

  void answer(const std::shared_ptr<local::socket>& socket) {
    auto buffer = std::make_shared<asio::streambuf>(1024);
    asio::async_read_until(*socket, *buffer, '\n', [this, socket, buffer](auto ec, std::size_t) {
      if (ec) return;
      std::istream in(buffer.get());
      std::string line;
      std::getline(in, line);
      auto reply = std::make_shared<std::string>("ok\n");
      const auto fault = parse_fault(line);
      if (!fault) {
        *reply = fault.error() + "\n";
      } else if (const auto applied = rig_.apply(*fault, now_s()); !applied) {
        *reply = applied.error() + "\n";
      }
      asio::async_write(*socket, asio::buffer(*reply), [socket, reply](auto, std::size_t) {});
    });
  }

  ServerOptions options_;
  std::chrono::steady_clock::time_point start_{std::chrono::steady_clock::now()};
  BenchRig rig_;
  std::vector<std::unique_ptr<Pty>> ports_;
  std::vector<std::string> backlog_;
  asio::steady_timer timer_;
  local::acceptor acceptor_;
  asio::signal_set signals_;
  bool stopping_{false};
};

}  // namespace

int serve(Scenario scenario, const ServerOptions& options) {
  std::signal(SIGPIPE, SIG_IGN);
  asio::io_context io(1);
  Server server(io, std::move(scenario), options);
  const bool started = server.start();
  if (started) io.run();
  server.clean_up();
  return started ? 0 : 1;
}

int send_fault(const std::string& dir, const std::string& line) {
  asio::io_context io(1);
  local::socket socket(io);
  boost::system::error_code ec;
  socket.connect(local::endpoint(fault_socket(dir)), ec);
  if (ec) {
    fmt::print(stderr, "mgt-rig: no rig in {} ({}); start one with mgt-rig run --dir {}\n", dir, ec.message(),
               dir);
    return 3;
  }
  asio::write(socket, asio::buffer(line + "\n"), ec);
  asio::streambuf buffer;
  asio::read_until(socket, buffer, '\n', ec);
  std::istream in(&buffer);
  std::string reply;
  std::getline(in, reply);
  fmt::print("{}\n", reply);
  return reply == "ok" ? 0 : 1;
}

}  // namespace mgtd::rig
