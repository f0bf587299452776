// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <utility>

#include <boost/asio/io_context.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "daemon/serve/console/console_token.h"
#include "daemon/serve/console/job_desk.h"
#include "daemon/serve/peer.h"
#include "daemon/serve/request_rate.h"
#include "proto/error.h"

/// The console server answers browsers, on the daemon's io_context:
///
///     GET /, /page/NAME        the page, compiled in
///     GET /api/hello           what the page has to know before anything else, JSON
///     GET /metrics             Prometheus text
///     GET /lane?...            history of one channel (lane_request.h)
///     GET /run/course          what the run has gained so far (proto/run_course.h)
///     GET /run/events          what it wrote down of itself (proto/run_log.h)
///     GET /runs                run files and pose tables (job_desk.h)
///     POST /jobs, GET and DELETE /jobs/N, GET /jobs/N/result
///                              computations on them, with the token in Authorization: Bearer ..
///     WebSocket /stream        the lines of the live stream, as on its own sockets
///     WebSocket /control       the lines of the control socket, after a first line {"token":".."}
///
/// Who is answered: host_rule.h for every request; control and jobs need the token and, unless the
/// configuration allows the network, a browser on this computer. Answers forbid the page everything but
/// itself (Content Security Policy, trusted types). There is no cookie, so no page of others can ride on one.
///
/// Requests have 8 kB and ten seconds for all of their bytes, a job's body 64 kB after its token was seen to
/// be right; connections and their rate are limited; a wrong token is answered late and counted (refusals.h);
/// a peer that does not read is dropped by the server that feeds it. Everything runs on the io_context's
/// thread; the server must not outlive the io_context.
namespace mgtd::daemon::serve::console {

struct ConsoleConfig {
  std::string listen{"127.0.0.1:7451"};  ///< empty: no console
  std::vector<std::string> hosts{};      ///< further names under which it is reached
  bool control_from_network{false};      ///< else from this computer alone
  std::size_t max_connections{48};
  std::chrono::milliseconds patience{10'000};  ///< for a request, an answer, or the first line of control
  std::chrono::milliseconds wrong_token_wait{1'000};  ///< so that guessing takes long
  RateLimit rate{.per_s = 40, .burst = 400};          ///< of requests, all clients together
  std::optional<WorkbenchConfig> workbench{};         ///< runs to work on
};

/// What the owner answers; what is empty is not there.
struct ConsoleSource {
  std::function<std::string()> hello, metrics, course;
  std::function<Result<std::string>()> events;
  std::function<Result<std::string>(std::string_view query)> lane;
  std::function<void(std::shared_ptr<Peer>)> stream;
  std::function<void(std::shared_ptr<Peer>, std::string via)> control;
};

class ConsoleServer {
 public:
  ConsoleServer(boost::asio::io_context& io, ConsoleConfig config, ConsoleSource source);
  ~ConsoleServer();
  ConsoleServer(const ConsoleServer&) = delete;
  ConsoleServer& operator=(const ConsoleServer&) = delete;

  /// Binds and listens; nothing where the configuration names no address.
  [[nodiscard]] Result<void> start();
  void stop();

  /// "http://127.0.0.1:7451/"; empty while it does not listen.
  [[nodiscard]] std::string address() const;
  [[nodiscard]] const ConsoleToken& token() const;
  /// How often control or a computation was refused since the start.
  [[nodiscard]] std::uint64_t refused() const;

 private:
  class State;
  std::shared_ptr<State> state_;
};

}  // namespace mgtd::daemon::serve::console
