// SPDX-License-Identifier: Apache-2.0
#include "daemon/serve/console/run_folder.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "daemon/store/run_file.h"
#include "proto/json_line.h"
#include "proto/time.h"

namespace mgtd::daemon::serve::console {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMostTableBytes = 64'000'000;  // longer ones are not counted

/// Size and time of a regular file; nothing for anything else.
std::optional<std::pair<std::uintmax_t, std::int64_t>> seen(const fs::path& path) {
  struct stat found {};
  if (::stat(path.c_str(), &found) != 0 || !S_ISREG(found.st_mode)) return std::nullopt;
  constexpr std::int64_t kPerSecond = 1'000'000'000;
  return std::pair{static_cast<std::uintmax_t>(found.st_size),
                   found.st_mtim.tv_sec * kPerSecond + found.st_mtim.tv_nsec};
}

/// Rows behind the head; nothing for a table that is no pose table.
std::optional<std::size_t> rows_of(const fs::path& path) {
  std::ifstream in(path);
  std::string line;
  if (!std::getline(in, line) || line.find("s1_x_nT") == std::string::npos) return std::nullopt;
  std::size_t rows = 0;
  while (std::getline(in, line)) rows += line.find_first_not_of(" \t\r") != std::string::npos ? 1U : 0U;
  return rows;
}

}  // namespace

RunFolder::RunFolder(const fs::path& path) {
  std::error_code ec;
  const fs::path whole = fs::absolute(path, ec).lexically_normal();
  const bool one = fs::is_regular_file(whole, ec);
  folder_ = one ? whole.parent_path() : whole;
  if (one) stem_ = whole.stem().string();
}

std::vector<RunEntry> RunFolder::entries() const {
  std::vector<RunEntry> out;
  std::error_code ec;
  for (fs::directory_iterator at(folder_, ec), end; !ec && at != end; at.increment(ec)) {
    const fs::path& path = at->path();
    const std::string extension = path.extension().string();
    if (extension != ".mgtrun" && extension != ".csv") continue;
    if (!stem_.empty() && path.stem() != stem_) continue;
    const auto file = seen(path);
    if (!file) continue;
    RunEntry entry{.name = path.filename().string(),
                   .table = extension == ".csv",
                   .bytes = file->first,
                   .changed_ns = file->second};
    if (const auto log = seen(path.string() + "-wal")) {
      entry.bytes += log->first;
      entry.changed_ns = std::max(entry.changed_ns, log->second);
    }
    out.push_back(std::move(entry));
  }
  std::sort(out.begin(), out.end(), [](const RunEntry& a, const RunEntry& b) {
    return a.changed_ns != b.changed_ns ? a.changed_ns > b.changed_ns : a.name < b.name;
  });
  return out;
}

void RunFolder::look_into(const fs::path& path, RunEntry& entry) {
  if (entry.table) {
    if (entry.bytes <= kMostTableBytes) entry.poses = rows_of(path);
    return;
  }
  const auto file = store::RunFile::open(path, store::Access::read_only);
  if (!file) return;
  entry.rig = file->header().rig;
  if (const auto poses = file->pose_count()) entry.poses = *poses;
  if (const auto state = file->state()) entry.state = std::string(mgtd::name(state->state));
}

std::vector<RunEntry> RunFolder::list() {
  std::vector<RunEntry> out = entries();
  std::set<std::string> there;
  int left = kNewAtOnce;
  for (RunEntry& entry : out) {
    there.insert(entry.name);
    const auto known = looked_.find(entry.name);
    if (known != looked_.end() && known->second.bytes == entry.bytes &&
        known->second.changed_ns == entry.changed_ns) {
      entry = known->second;
    } else if (left > 0) {
      --left;
      look_into(folder_ / entry.name, entry);
      looked_[entry.name] = entry;
    }
  }
  std::erase_if(looked_, [&](const auto& known) { return there.count(known.first) == 0; });
  return out;
}

Result<fs::path> RunFolder::find(std::string_view name) const {
  for (const RunEntry& entry : entries())
    if (entry.name == name) return folder_ / entry.name;
  return fail(ErrorCode::usage, fmt::format("there is no run {}", excerpt(name)),
              "take a name from the list of runs");
}

std::string RunFolder::stamp(std::string_view name) const {
  const fs::path path = folder_ / name;
  const auto file = seen(path);
  const auto log = seen(path.string() + "-wal");
  return fmt::format("{} {} {} {}", file ? file->first : 0, file ? file->second : 0, log ? log->first : 0,
                     log ? log->second : 0);
}

std::string to_json(const std::vector<RunEntry>& runs) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const RunEntry& r : runs) {
    list.push_back({{"name", r.name},
                    {"kind", r.table ? "table" : "run"},
                    {"bytes", r.bytes},
                    {"changed", format_utc({r.changed_ns})},
                    {"poses", r.poses ? nlohmann::ordered_json(*r.poses) : nlohmann::ordered_json()},
                    {"rig", r.rig},
                    {"state", r.state}});
  }
  return nlohmann::ordered_json{{"runs", std::move(list)}}.dump(-1, ' ', false,
                                                                nlohmann::json::error_handler_t::replace) +
         '\n';
}

}  // namespace mgtd::daemon::serve::console
