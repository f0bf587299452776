// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <utility>

#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "daemon/serve/peer.h"
#include "daemon/serve/request_rate.h"
#include "proto/control_codec.h"
#include "proto/error.h"
#include "proto/status_report.h"

/// The server of the control socket (control_codec.h) obeys everyone who may connect; the file's mode says
/// who that is. It reads requests, has them answered, and sends the replies in order. Who has control is
/// decided by control_lease.h and answered here; the rest is the handler's. A client that asks too often,
/// sends too long a line or does not read is told why and disconnected.
///
/// Everything runs on the io_context's thread; the server must not outlive the io_context.
namespace mgtd::daemon::serve {

struct ControlConfig {
  std::string path{"/run/mgtd/control.sock"};
  int mode{0660};
  std::size_t max_clients{32};
  RateLimit rate{.per_s = 50, .burst = 200};  ///< of requests, per client
};

class ControlServer {
 public:
  /// Must answer at once; what takes long is started, and its progress asked for (run.status).
  using Handler = std::function<Result<nlohmann::ordered_json>(const ControlRequest&)>;

  ControlServer(boost::asio::io_context& io, ControlConfig config, Handler handler);
  ~ControlServer();
  ControlServer(const ControlServer&) = delete;
  ControlServer& operator=(const ControlServer&) = delete;

  [[nodiscard]] Result<void> start();
  /// One more client, whose connection is not yet started; `via`: how it came, for those who are refused.
  void admit(const std::shared_ptr<Peer>& peer, std::string via);
  void stop();
  [[nodiscard]] ControlStatus stats() const;

 private:
  class State;
  std::shared_ptr<State> state_;
};

}  // namespace mgtd::daemon::serve
