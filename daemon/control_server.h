// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <utility>

#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "proto/control_codec.h"
#include "proto/error.h"

/// The control socket (control_codec.h): who may connect may command, and the file's mode says who that is.
/// Reads requests, has them answered, sends the replies in order. Decides nothing itself.
///
/// Everything runs on the io_context's thread; the server must not outlive the io_context.
namespace mgtd::daemon {

struct ControlConfig {
  std::string path{"/run/mgtd/control.sock"};
  int mode{0660};
  std::size_t max_clients{32};
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
  void stop();
  [[nodiscard]] std::size_t clients() const;

 private:
  class State;
  std::shared_ptr<State> state_;
};

}  // namespace mgtd::daemon
