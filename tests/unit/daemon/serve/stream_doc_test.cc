// SPDX-License-Identifier: Apache-2.0
// The Python that docs/stream.md shows is run as it stands there.
#include <gtest/gtest.h>

#include <boost/asio/io_context.hpp>
#include <chrono>
#include <fstream>
#include <memory>
#include <string>

#include "daemon/serve/stream_server.h"
#include "tests/support/checkout.h"
#include "tests/support/child_process.h"
#include "tests/support/event_loop.h"
#include "tests/support/whole_file.h"

namespace mgtd::daemon::serve {
namespace {

std::string python_of(const std::string& document) {
  const std::string all = mgtd::testing::whole_file(document);
  const std::string fence = "```python\n";
  const std::size_t begin = all.find(fence);
  if (begin == std::string::npos) return {};
  return all.substr(begin + fence.size(), all.find("```", begin + fence.size()) - begin - fence.size());
}

TEST(StreamDocument, ItsPythonReadsTheStream) {
  boost::asio::io_context io;
  const mgtd::testing::ScratchDirectory scratch;
  StreamConfig config;
  config.tcp = "127.0.0.1:0";
  config.unix_path.clear();
  StreamServer server(io, config, {"rig 7", "mgtd test"});
  ASSERT_TRUE(server.start());

  std::string code = python_of(mgtd::testing::source_path("docs/stream.md"));
  const std::size_t port = code.find("7450");
  ASSERT_NE(port, std::string::npos);
  code.replace(port, 4, std::to_string(server.tcp_port()));
  std::ofstream(scratch / "reader.py") << code;
  mgtd::testing::ChildProcess python({"python3", "-u", scratch / "reader.py"}, scratch / "", "python");

  TensorSample sample;
  sample.calibration_id = std::make_shared<const std::string>("c1");
  sample.g_nT_per_m.xx = 12.5;
  sample.g_sd_nT_per_m.xx = 0.25;
  const auto printed = [&] { return python.out().find("Z 12.5 +- 0.25") != std::string::npos; };
  auto next = std::chrono::steady_clock::now();
  EXPECT_TRUE(mgtd::testing::run_until(io, [&] {
    if (const auto now = std::chrono::steady_clock::now(); server.stats().clients > 0 && now >= next) {
      next = now + std::chrono::milliseconds(1);  // Python must keep up
      ++sample.seq;
      sample.t.mono += std::chrono::milliseconds(20);
      server.publish(sample);
    }
    return printed() || !python.running();
  }));
  EXPECT_TRUE(printed()) << python.out() << python.err();
  EXPECT_NE(python.out().find("rig: rig 7"), std::string::npos);
  server.stop();  // ends the loop over the lines
  ASSERT_TRUE(mgtd::testing::run_until(io, [&] { return !python.running(); }));
  EXPECT_NE(python.out().find("the daemon is stopping"), std::string::npos) << python.out() << python.err();
}

}  // namespace
}  // namespace mgtd::daemon::serve
