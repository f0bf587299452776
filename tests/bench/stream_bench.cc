// SPDX-License-Identifier: Apache-2.0
// What a sample costs from the epoch to the sockets. The pipeline must exceed 500 000 epochs per second.
#include <benchmark/benchmark.h>

#include <random>
#include <vector>

#include "calib/calibration/tensor.h"
#include "daemon/serve/sample_ring.h"
#include "daemon/serve/stream_server.h"
#include "proto/tensor_encoder.h"
#include "tests/support/event_loop.h"
#include "tests/support/line_peer.h"

namespace mgtd::daemon {
namespace {

using mgtd::testing::LinePeer;

/// A calibration as a run leaves it: gains, offsets, noise and a full covariance.
std::shared_ptr<const calib::calibration::Calibration> calibration() {
  auto c = std::make_shared<calib::calibration::Calibration>();
  c->id = "c0123456789ab";
  c->sample_noise_nT.setConstant(0.1);
  c->pose_noise_nT.setConstant(0.05);
  std::mt19937_64 random(3);
  std::normal_distribution<double> gauss(0, 1e-6);
  Eigen::MatrixXd root =
      Eigen::MatrixXd::NullaryExpr(calib::calibration::kArrayParameters, calib::calibration::kArrayParameters,
                                   [&] { return gauss(random); });
  c->covariance = root * root.transpose();
  return c;
}

std::vector<Epoch> epochs() {
  std::mt19937_64 random(1);
  std::normal_distribution<double> gauss(0, 100);
  std::vector<Epoch> out(1000);
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i].seq = i;
    out[i].t.wall.ns = 1'795'255'200'000'000'000 + static_cast<std::int64_t>(i) * 20'000'000;
    out[i].t.mono = Instant{Duration{static_cast<std::int64_t>(i) * 20'000'000}};
    for (Eigen::Vector3d& y : out[i].y_nT) {
      y = Eigen::Vector3d(20'000, -1'000, 45'000) +
          Eigen::Vector3d(gauss(random), gauss(random), gauss(random));
    }
  }
  return out;
}

std::vector<TensorSample> samples() {
  const calib::calibration::TensorPipeline pipeline(calibration());
  std::vector<TensorSample> out;
  for (const Epoch& epoch : epochs()) out.push_back(pipeline.apply(epoch));
  return out;
}

void encode_tensor(benchmark::State& state) {
  const auto input = samples();
  TensorEncoder encoder;
  std::size_t i = 0;
  std::size_t bytes = 0;
  for (auto _ : state) bytes += encoder.encode(input[i++ % input.size()]).size();
  state.SetItemsProcessed(state.iterations());
  state.SetBytesProcessed(static_cast<std::int64_t>(bytes));
}
BENCHMARK(encode_tensor);

void apply_tensor(benchmark::State& state) {
  const auto input = epochs();
  const calib::calibration::TensorPipeline pipeline(calibration());
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(pipeline.apply(input[i++ % input.size()]));
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(apply_tensor);

/// Epoch -> calibrated tensor with standard deviations -> line -> ring.
void pipeline_epochs(benchmark::State& state) {
  const auto input = epochs();
  const calib::calibration::TensorPipeline pipeline(calibration());
  TensorEncoder encoder;
  serve::SampleRing ring(serve::StreamConfig{}.ring_lines);
  std::size_t i = 0;
  for (auto _ : state) {
    const TensorSample sample = pipeline.apply(input[i++ % input.size()]);
    ring.push_sample(sample.seq, sample.t.mono, encoder.encode(sample));
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(pipeline_epochs);

/// publish() alone, with clients that watch everything and read: what acquisition pays.
/// `served` in nanoseconds: what writing to all of them costs afterwards, per sample.
void publish(benchmark::State& state) {
  boost::asio::io_context io;
  const mgtd::testing::ScratchDirectory scratch;
  serve::StreamConfig config;
  config.tcp.clear();
  config.unix_path = scratch / "stream.sock";
  serve::StreamServer server(io, config, {});
  if (!server.start()) return state.SkipWithError("cannot listen");
  std::vector<LinePeer> clients;
  for (std::int64_t n = 0; n < state.range(0); ++n) {
    clients.push_back(LinePeer::unix_socket(config.unix_path));
    clients.back().send_line(R"({"watch":{}})");
  }
  const auto settled = [&] { return server.stats().accepted == clients.size(); };
  if (!mgtd::testing::run_until(io, settled)) return state.SkipWithError("clients were not accepted");
  io.poll();

  const auto input = samples();
  std::size_t i = 0;
  std::chrono::nanoseconds serving{0};
  for (auto _ : state) {
    server.publish(input[i++ % input.size()]);
    state.PauseTiming();
    const auto before = std::chrono::steady_clock::now();
    io.restart();
    io.poll();
    serving += std::chrono::steady_clock::now() - before;
    if (i % 64 == 0) {
      for (LinePeer& client : clients) {
        client.pump();
        client.lines.clear();
      }
    }
    state.ResumeTiming();
  }
  state.counters["served_ns"] =
      static_cast<double>(serving.count()) / static_cast<double>(state.iterations());
  state.counters["lost"] = static_cast<double>(server.stats().gaps);
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(publish)->Arg(0)->Arg(1)->Arg(16)->Iterations(100'000);

}  // namespace
}  // namespace mgtd::daemon
