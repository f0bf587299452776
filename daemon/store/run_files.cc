// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/run_files.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <system_error>
#include <tuple>

namespace mgtd::daemon::store {
namespace {

constexpr const char* kRunSuffix = ".mgtrun";

}  // namespace

std::vector<RunFiles::Entry> RunFiles::last_first() {
  std::vector<Entry> out;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(directory_, ignored)) {
    if (entry.path().extension() != kRunSuffix) continue;
    const auto file = RunFile::open(entry.path(), Access::read_only);
    const auto state = file ? file->state() : tl::unexpected(file.error());
    if (state) {
      out.push_back({file->header().number, entry.path(), state->state});
    } else {
      spdlog::warn("{}: {}", entry.path().string(), state.error().text());
    }
  }
  std::sort(out.begin(), out.end(), [](const Entry& a, const Entry& b) {
    return std::tie(a.number, a.path) > std::tie(b.number, b.path);
  });
  last_number_ = out.empty() ? 0 : out.front().number;
  return out;
}

Result<RunFile> RunFiles::create(RunHeader header) {
  if (!last_number_) std::ignore = last_first();
  header.number = *last_number_ + 1;
  auto file = RunFile::create(directory_ / (header.run_id + kRunSuffix), header);
  if (file) last_number_ = header.number;
  return file;
}

}  // namespace mgtd::daemon::store
