// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <utility>

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "daemon/serve/peer.h"
#include "daemon/serve/request_rate.h"
#include "daemon/store/disk_ring.h"
#include "proto/epoch.h"
#include "proto/error.h"
#include "proto/input_value.h"
#include "proto/status_report.h"
#include "proto/stream_class.h"
#include "proto/stream_codec.h"
#include "proto/tensor.h"

/// The server of the live stream sends NDJSON over TCP and a Unix socket, the same objects on both; clients
/// cannot change anything. A client is greeted with HELLO and hears nothing more until it sends a watch
/// (watch_request.h).
///
/// Every sample is encoded once, into a ring of lines that all clients read at their own pace. publish()
/// writes to no socket: clients are served afterwards on the io_context, without blocking, so that none
/// delays acquisition or another client. A client that the ring overtakes is told so with a GAP, and is
/// disconnected with a reason when it stays behind, floods or asks too often.
///
/// Everything runs on the io_context's thread; the server must not outlive the io_context.
namespace mgtd::daemon::serve {

struct StreamConfig {
  std::string tcp{"127.0.0.1:7450"};               ///< empty: no TCP
  std::string unix_path{"/run/mgtd/stream.sock"};  ///< empty: no Unix socket
  int unix_mode{0666};                             ///< reading is for everyone who may enter the directory
  std::size_t max_clients{64};
  RateLimit rate{.per_s = 10, .burst = 64};  ///< of lines from one client
  std::size_t ring_lines{2'048};  ///< in memory: how late a client may be; what is older is read from disk
};

class StreamServer {
 public:
  StreamServer(boost::asio::io_context& io, StreamConfig config, Greeting greeting);
  ~StreamServer();
  StreamServer(const StreamServer&) = delete;
  StreamServer& operator=(const StreamServer&) = delete;

  /// What is published is also kept on disk, and clients go back to what is there. Before start(); the ring
  /// outlives the server. Begins with what lies between the last life and this one.
  void keep(store::DiskRing& disk);
  /// Binds and listens. On an error nothing is left listening.
  [[nodiscard]] Result<void> start();
  /// One more client, whose connection is not yet started: greeted and served like those of the sockets.
  void admit(const std::shared_ptr<Peer>& peer);
  /// Says why to every client, closes, removes the Unix socket.
  void stop();

  /// `inputs`: what the rig measures beside the field.
  void publish(const TensorSample& sample, std::span<const InputValue> inputs = {});
  void publish(const Gap& gap);
  void publish(const StatusReport& report);
  void publish(const RunStatus& run);
  void publish(const SensorsReport& sensors);
  /// A line that is already encoded (without its line end), for STATUS, RUN and SENSORS.
  void publish_line(StreamClass stream_class, std::string_view line);

  [[nodiscard]] StreamStatus stats() const;
  /// The TCP port that was bound (of interest when the configuration said 0); 0 without TCP.
  [[nodiscard]] std::uint16_t tcp_port() const;

 private:
  class State;
  std::shared_ptr<State> state_;
};

}  // namespace mgtd::daemon::serve
