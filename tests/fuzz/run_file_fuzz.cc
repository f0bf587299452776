// SPDX-License-Identifier: Apache-2.0
// Whatever bytes a *.mgtrun consists of: opening and reading every part of it answers or refuses, and a
// file that is only read is not changed by it.
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "daemon/store/durable_file.h"
#include "daemon/store/run_file.h"
#include "tests/fuzz/require.h"

namespace {

using mgtd::testing::require;

std::string bytes_of(const std::filesystem::path& path) {
  return mgtd::daemon::store::read_file(path).value();
}

void read_all(const mgtd::daemon::store::RunFile& run) {
  static_cast<void>(run.poses());
  static_cast<void>(run.pose_count());
  static_cast<void>(run.path_readings());
  static_cast<void>(run.events());
  static_cast<void>(run.state());
  static_cast<void>(run.checks("preflight"));
  static_cast<void>(run.document("proposed"));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const auto path =
      std::filesystem::temp_directory_path() / ("mgtd-fuzz-" + std::to_string(::getpid()) + ".mgtrun");
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
  {
    const auto run = mgtd::daemon::store::RunFile::open(path, mgtd::daemon::store::Access::read_only);
    if (run) {
      read_all(*run);
    } else {
      require(!run.error().message.empty() && !run.error().remedy.empty());
    }
  }
  require(bytes_of(path) == bytes);
  std::filesystem::remove(path);
  return 0;
}
