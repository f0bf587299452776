// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/rotated_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <system_error>
#include <tuple>

namespace mgtd::daemon::store {

namespace fs = std::filesystem;

fs::path rotated_name(const fs::path& directory, const std::string& stem, std::uint64_t number,
                      const std::string& suffix) {
  return directory / fmt::format("{}.{:06}{}", stem, number, suffix);
}

std::vector<RotatedFile> rotated_files(const fs::path& directory, const std::string& prefix,
                                       const std::string& suffix) {
  std::vector<RotatedFile> out;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(directory, error)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(prefix) || !name.ends_with(suffix)) continue;
    std::error_code gone;
    RotatedFile file{entry.path(), entry.file_size(gone), entry.last_write_time(gone)};
    if (!gone) out.push_back(std::move(file));
  }
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.path < b.path; });
  return out;
}

std::uint64_t next_number(const fs::path& directory, const std::string& stem, const std::string& suffix) {
  const auto files = rotated_files(directory, stem + ".", suffix);
  if (files.empty()) return 0;
  const std::string name = files.back().path.filename().string();
  return std::strtoull(name.c_str() + stem.size() + 1, nullptr, 10) + 1;
}

std::vector<RotatedFile> by_age(std::vector<RotatedFile> files, const std::string& stem,
                                fs::file_time_type now) {
  constexpr std::chrono::hours kClockBehind{24};  // after a start without a clock that runs on
  const auto age = [&](const RotatedFile& file) {
    const bool own = file.path.filename().string().starts_with(stem + ".");
    const bool wrong = !own && file.written > now + kClockBehind;
    return std::tuple(own, !wrong, own ? fs::file_time_type() : file.written, file.path);
  };
  std::sort(files.begin(), files.end(), [&](const auto& a, const auto& b) { return age(a) < age(b); });
  return files;
}

std::size_t remove_oldest(const std::vector<RotatedFile>& files, const KeepRule& rule, std::uint64_t coming) {
  std::uint64_t total = coming;
  for (const RotatedFile& file : files) total += file.bytes;
  const auto now = fs::file_time_type::clock::now();
  std::size_t removed = 0;
  for (const RotatedFile& file : files) {
    const bool too_many = rule.bytes > 0 && total > rule.bytes;
    const bool too_old = rule.age > Duration{0} && now - file.written > rule.age;
    if (!too_many && !too_old) continue;
    std::error_code error;
    if (fs::remove(file.path, error)) ++removed;
    total -= file.bytes;
  }
  return removed;
}

}  // namespace mgtd::daemon::store
