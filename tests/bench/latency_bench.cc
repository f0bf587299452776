// SPDX-License-Identifier: Apache-2.0
// From the last byte of a sample in a serial port to its TENSOR line in a client: four digitisers at 50 Hz on
// pseudo terminals, the real drivers, sampler, tensor arithmetic and stream server on one thread, as in the
// daemon. The median must stay below 1 ms. Time is told by counters, in microseconds.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <ctime>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "calib/calibration/tensor.h"
#include "daemon/acquire/sampler.h"
#include "daemon/serve/console/job_desk.h"
#include "daemon/serve/stream_reader.h"
#include "daemon/serve/stream_server.h"
#include "drivers/port_link.h"
#include "drivers/registry.h"
#include "tests/support/checkout.h"
#include "tests/support/child_process.h"
#include "tests/support/event_loop.h"
#include "tests/support/line_peer.h"
#include "tests/support/pty.h"

namespace mgtd::daemon {
namespace {

using HostClock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kPeriod{20};
constexpr std::size_t kWanted = 250;

/// A digitiser that agrees to everything and then streams one constant field.
class Digitiser {
 public:
  explicit Digitiser(const std::string& path) : pty_(path) {}

  void answer() {
    const std::string& received = pty_.received();
    for (std::size_t end = received.find('\r', read_); end != std::string::npos;
         end = received.find('\r', read_)) {
      reply(received.substr(read_, end - read_));
      read_ = end + 1;
    }
  }
  void send_sample() { pty_.write("*100000000000180000A\r"); }
  [[nodiscard]] bool streaming() const { return streaming_; }

 private:
  void reply(std::string command) {
    command.erase(0, command.find_first_not_of('|'));
    if (command == "$01M") pty_.write("!01<obsDAQ V5.5.7>\r");
    if (command == "$01SN") pty_.write("!01SN1001\r");
    if (command.starts_with("#01PP")) pty_.write("!01" + command.substr(5) + "\r");
    if (command.size() == 14 && command.substr(4, 2) == "WS") pty_.write("!01" + command.substr(6) + "\r");
    if (command == "#01CS") {
      pty_.write("!01\r");
      streaming_ = true;
    }
  }

  mgtd::testing::PtyMaster pty_;
  std::size_t read_{0};
  bool streaming_{false};
};

/// Four digitisers on a thread of their own, `stagger` apart; remembers when each write of a sample began.
class Instruments {
 public:
  Instruments(const mgtd::testing::ScratchDirectory& scratch, std::chrono::milliseconds stagger)
      : stagger_(stagger) {
    for (int i = 0; i < kSensors; ++i) {
      digitisers_.push_back(std::make_unique<Digitiser>(scratch / fmt::format("s{}", i + 1)));
    }
    written_.reserve(100'000);
    thread_ = std::thread([this] { run(); });
  }
  /// When the writes began, in order.
  const std::vector<HostClock::time_point>& stop() {
    stopping_ = true;
    thread_.join();
    return written_;
  }

 private:
  void run() {
    for (auto due = HostClock::now(); !stopping_; due += kPeriod) {
      for (const auto& digitiser : digitisers_) {
        if (digitiser->streaming()) {
          // Before the write: the line may be with the client before the write returns.
          written_.push_back(HostClock::now());
          digitiser->send_sample();
        } else {
          digitiser->answer();
        }
        if (stagger_.count() > 0) std::this_thread::sleep_for(stagger_);
      }
      std::this_thread::sleep_until(due + kPeriod);
    }
  }

  std::vector<std::unique_ptr<Digitiser>> digitisers_;
  std::chrono::milliseconds stagger_;
  std::vector<HostClock::time_point> written_;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

/// The live path of the daemon and nothing else.
class Acquisition {
 public:
  Acquisition(boost::asio::io_context& io, const mgtd::testing::ScratchDirectory& scratch,
              serve::StreamServer& server)
      : server_(server) {
    for (int slot = 0; slot < kSensors; ++slot) {
      drivers::Settings settings(fmt::format("sensor s{}", slot + 1), 1);
      settings.set("profile", std::string("mag-13-100"), 1);
      const drivers::DriverEntry* const driver = drivers::find_driver("obsdaq");
      const auto at = static_cast<std::size_t>(slot);
      drivers::LinkCallbacks callbacks;
      callbacks.on_send = [this, at](std::string_view bytes) { ports_[at]->send(bytes); };
      callbacks.on_events = [this](const std::vector<DeviceEvent>& events, Stamp) { take(events); };
      links_.push_back(std::make_unique<drivers::DeviceLink>(
          std::shared_ptr<drivers::Device>(driver->make(slot, settings)), std::move(callbacks)));
      ports_.push_back(std::make_unique<drivers::PortLink>(
          io, clock_, drivers::PortSettings{scratch / fmt::format("s{}", slot + 1), 19200}, *links_.back()));
      ports_.back()->start();
    }
  }

 private:
  void take(const std::vector<DeviceEvent>& events) {
    complete_.clear();
    for (const DeviceEvent& event : events) {
      if (const auto* reading = std::get_if<FieldReading>(&event)) sampler_.push(*reading, complete_);
    }
    for (const EpochOrGap& entry : complete_) {
      if (const auto* epoch = std::get_if<Epoch>(&entry)) {
        server_.publish(pipeline_.apply(*epoch));
      } else {
        server_.publish(std::get<Gap>(entry));
      }
    }
  }

  serve::StreamServer& server_;
  drivers::Clock clock_;
  acquire::Sampler sampler_{acquire::SamplerConfig{}};
  calib::calibration::TensorPipeline pipeline_{calib::sensor::Geometry{}};
  std::vector<EpochOrGap> complete_;
  std::vector<std::unique_ptr<drivers::DeviceLink>> links_;
  std::vector<std::unique_ptr<drivers::PortLink>> ports_;
};

/// When each TENSOR line had been received.
std::vector<HostClock::time_point> receive(const std::string& where, std::size_t wanted = kWanted) {
  std::vector<HostClock::time_point> out;
  WatchRequest request{StreamClasses{}, std::nullopt, std::nullopt};
  request.classes.add(StreamClass::tensor);
  auto reader = serve::StreamReader::open(where, request);
  while (reader && out.size() < wanted) {
    const auto line = reader->next_line(std::chrono::seconds(30));
    const auto now = HostClock::now();
    if (!line || !*line) break;
    if ((*line)->find("\"TENSOR\"") != std::string::npos) out.push_back(now);
  }
  return out;
}

/// From the last write before each reception.
std::vector<double> latencies_us(const std::vector<HostClock::time_point>& written,
                                 const std::vector<HostClock::time_point>& received) {
  std::vector<double> out;
  for (const auto at : received) {
    const auto after = std::upper_bound(written.begin(), written.end(), at);
    if (after != written.begin())
      out.push_back(std::chrono::duration<double, std::micro>(at - *(after - 1)).count());
  }
  std::sort(out.begin(), out.end());
  return out;
}

void bytes_to_client(benchmark::State& state) {
  for (auto _ : state) {
    const mgtd::testing::ScratchDirectory scratch;
    Instruments instruments(scratch, std::chrono::milliseconds(state.range(0)));
    boost::asio::io_context io;
    serve::StreamConfig config;
    config.tcp.clear();
    config.unix_path = scratch / "stream.sock";
    serve::StreamServer server(io, config, {});
    if (!server.start()) return state.SkipWithError("cannot listen");
    std::vector<double> us;
    {
      const Acquisition acquisition(io, scratch, server);
      std::vector<HostClock::time_point> received;
      std::thread client([&] {
        received = receive(config.unix_path);
        io.stop();
      });
      io.run();
      client.join();
      us = latencies_us(instruments.stop(), received);
    }
    if (us.size() < kWanted) return state.SkipWithError("too few samples came");
    state.counters["median_us"] = us[us.size() / 2];
    state.counters["p95_us"] = us[us.size() * 95 / 100];
    state.counters["max_us"] = us.back();
  }
}
double thread_cpu_s() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// One that asks for everything and then does not read, or a byte a second.
class BadClient {
 public:
  BadClient(const std::string& where, bool reads_a_byte)
      : peer_(mgtd::testing::LinePeer::unix_socket(where)) {
    peer_.send_line(R"({"watch":{}})");
    if (!reads_a_byte) return;
    thread_ = std::thread([this] {
      while (!stopping_) {
        peer_.pump(1);
        std::this_thread::sleep_for(std::chrono::seconds(1));
      }
    });
  }
  ~BadClient() {
    stopping_ = true;
    if (thread_.joinable()) thread_.join();
  }

 private:
  mgtd::testing::LinePeer peer_;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

/// A search for effects after the other, as the jobs of the console run: `mgt explain` on a table of 157
/// poses.
class Searches {
 public:
  Searches(boost::asio::io_context& io, std::string table) : io_(io), table_(std::move(table)) { begin(); }
  [[nodiscard]] int ended() const { return ended_; }
  [[nodiscard]] const std::string& trouble() const { return trouble_; }

 private:
  void begin() {
    auto process = serve::console::JobProcess::start(
        io_, {serve::console::mgt_beside_us().string(), "explain", table_, "--json"}, {},
        [this](const serve::console::JobEnd& end) {
          if (!end.why.empty() || end.out.empty()) trouble_ = "mgt explain failed: " + end.why;
          ++ended_;
          if (trouble_.empty()) begin();
        });
    if (process)
      process_ = *std::move(process);
    else
      trouble_ = process.error().text();
  }

  boost::asio::io_context& io_;
  std::string table_, trouble_;
  std::shared_ptr<serve::console::JobProcess> process_;
  int ended_{0};
};

/// The table of 157 poses with a hidden effect, by mgt-rig beside us; empty where that failed.
std::string hidden_effect(const mgtd::testing::ScratchDirectory& scratch) {
  std::string table = scratch / "poses.csv";
  const auto made = mgtd::testing::run_program(
      {(serve::console::mgt_beside_us().parent_path() / "mgt-rig").string(), "table", "--scenario",
       mgtd::testing::source_path("tests/scenarios/hidden_temperature.toml"), "-o", table},
      scratch / "");
  return made.exit_code == 0 ? table : std::string();
}

/// 16 clients at 50 Hz, one dead and one that reads a byte a second: what the 14 others wait, and what the
/// thread that acquires and serves takes of a core; `job`: while a computation runs. Goals: 99th percentile
/// 5 ms, 10 % of a core.
void sixteen_clients(benchmark::State& state) {
  constexpr std::size_t kReaders = 14, kSamples = 1500;
  for (auto _ : state) {
    const mgtd::testing::ScratchDirectory scratch;
    const bool with_job = state.range(0) != 0;
    const std::string table = with_job ? hidden_effect(scratch) : std::string();
    if (with_job && table.empty()) return state.SkipWithError("needs mgt and mgt-rig beside it");
    Instruments instruments(scratch, std::chrono::milliseconds(0));
    boost::asio::io_context io;
    serve::StreamConfig config;
    config.tcp.clear();
    config.unix_path = scratch / "stream.sock";
    serve::StreamServer server(io, config, {});
    if (!server.start()) return state.SkipWithError("cannot listen");
    std::vector<std::vector<HostClock::time_point>> received(kReaders);
    double cpu_share = 0;
    std::optional<Searches> searches;
    if (with_job) searches.emplace(io, table);
    {
      const Acquisition acquisition(io, scratch, server);
      const BadClient dead(config.unix_path, false), slow(config.unix_path, true);
      std::atomic<std::size_t> left{kReaders};
      std::vector<std::thread> readers;
      for (auto& times : received) {
        readers.emplace_back([&] {
          times = receive(config.unix_path, kSamples);
          if (--left == 0) io.stop();
        });
      }
      const double cpu_s = thread_cpu_s();
      const auto begun = HostClock::now();
      io.run();
      cpu_share = (thread_cpu_s() - cpu_s) / std::chrono::duration<double>(HostClock::now() - begun).count();
      for (std::thread& reader : readers) reader.join();
    }
    const auto& written = instruments.stop();
    if (searches && !searches->trouble().empty()) return state.SkipWithError(searches->trouble().c_str());
    std::vector<double> us;
    for (const auto& times : received) {
      if (times.size() < kSamples) return state.SkipWithError("too few samples came");
      const auto one = latencies_us(written, times);
      us.insert(us.end(), one.begin(), one.end());
    }
    std::sort(us.begin(), us.end());
    state.counters["median_us"] = us[us.size() / 2];
    state.counters["p99_us"] = us[us.size() * 99 / 100];
    state.counters["max_us"] = us.back();
    state.counters["core_percent"] = 100 * cpu_share;
    if (searches) state.counters["searches"] = searches->ended();
    state.counters["gaps"] = static_cast<double>(server.stats().gaps);
  }
}
BENCHMARK(sixteen_clients)->ArgName("job")->Arg(0)->Arg(1)->Iterations(1)->Unit(benchmark::kSecond);

BENCHMARK(bytes_to_client)->ArgName("stagger_ms")->Arg(0)->Arg(4)->Iterations(1)->Unit(benchmark::kSecond);

}  // namespace
}  // namespace mgtd::daemon
