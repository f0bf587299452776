// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/journal_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string_view>
#include <tuple>
#include <utility>

#include "daemon/store/rotated_files.h"
#include "proto/raw_log.h"

namespace mgtd::daemon::cli {
namespace {

/// More than any header: its text has at most 65 535 bytes.
constexpr std::size_t kHeaderMost = 66'000;

/// A journal file and what it says of its place among the others.
struct JournalFile {
  std::string life;
  std::uint64_t number{0};
  std::string path;

  [[nodiscard]] auto place() const { return std::tie(life, number); }
};

/// "raw-01795255200.000003": the life, and the file's number in it.
std::pair<std::string, std::uint64_t> life_and_number(const std::string& name) {
  const std::size_t dot = name.rfind('.');
  if (dot == std::string::npos) return {name, 0};
  return {name.substr(0, dot), std::strtoull(name.c_str() + dot + 1, nullptr, 10)};
}

/// Empty if the daemon crashed before the header of the file was complete.
Result<std::optional<JournalFile>> header_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return fail(ErrorCode::bad_input, path + ": cannot be read", "check path and permissions");
  std::string piece(kHeaderMost, '\0');
  in.read(piece.data(), static_cast<std::streamsize>(piece.size()));
  if (in.bad())
    return fail(ErrorCode::io, path + ": cannot be read", "check that it is a file, and the disk");
  RawLogDecoder decoder;
  decoder.feed(
      std::string_view(piece).substr(0, static_cast<std::size_t>(std::max<std::streamsize>(0, in.gcount()))));
  static_cast<void>(decoder.next());
  if (decoder.good_bytes() > 0) {
    auto [life, number] = life_and_number(decoder.header().run_id);
    return JournalFile{std::move(life), number, path};
  }
  if (decoder.state() == RawLogDecoder::State::header && in.gcount() > 0) return std::nullopt;
  return fail(ErrorCode::bad_input, path + ": no journal of mgtd: it does not begin with a journal's header",
              "name the raw-*.raw files of the daemon's runs folder");
}

/// Those of one life, from the first that cannot be played; `missing` is the number before it.
Error cannot_play(const std::vector<JournalFile>& files, std::uint64_t missing) {
  const JournalFile& first = files.front();
  const std::string what =
      files.size() == 1 ? first.path
                        : fmt::format("{} to {} ({} files)", first.path, files.back().path, files.size());
  const auto before =
      store::rotated_name(std::filesystem::path(first.path).parent_path(), first.life, missing, ".raw");
  std::error_code ignored;
  if (std::filesystem::exists(before, ignored))
    return {ErrorCode::bad_input,
            fmt::format("{}: not played: {}, which comes before, is not named", what, before.string()),
            "name every file of the journal, from the first one of a start of the daemon on"};
  return {
      ErrorCode::bad_input,
      fmt::format("{}: not played: {}, which comes before, is gone: removed by journal_mb or journal_days, "
                  "or moved away. A replay begins with the first file of a start of the daemon",
                  what, before.filename().string()),
      "put it back if it is elsewhere; else raise journal_mb, or start the daemon anew from time to time: "
      "each start begins a journal that can be played"};
}

/// The files of one start of the daemon, in their order.
void divide(const std::vector<JournalFile>& life, Journals& out) {
  std::vector<JournalFile> rest;
  std::uint64_t next = 0;
  for (const JournalFile& file : life) {
    if (rest.empty() && file.number == next) {
      out.play.push_back(file.path);
      ++next;
    } else {
      rest.push_back(file);
    }
  }
  if (!rest.empty()) out.left_out.push_back(cannot_play(rest, rest.front().number - 1));
}

/// The files in the order they were written, each once.
Result<std::vector<JournalFile>> in_order(const std::vector<std::string>& paths) {
  std::vector<JournalFile> out;
  for (const std::string& path : paths) {
    auto file = header_of(path);
    if (!file) return tl::unexpected(file.error());
    if (*file) {
      out.push_back(**std::move(file));
    } else {
      fmt::print(stderr, "{}: ends within its header; nothing to play\n", path);
    }
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const auto& a, const auto& b) { return a.place() < b.place(); });
  out.erase(std::unique(out.begin(), out.end(),
                        [](const auto& a, const auto& b) { return a.place() == b.place(); }),
            out.end());
  return out;
}

}  // namespace

Result<Journals> journals_of(const std::vector<std::string>& paths) {
  const auto files = in_order(paths);
  if (!files) return tl::unexpected(files.error());
  Journals out;
  for (auto begin = files->begin(); begin != files->end();) {
    const auto end = std::find_if(begin, files->end(), [&](const auto& f) { return f.life != begin->life; });
    divide({begin, end}, out);
    begin = end;
  }
  if (!out.play.empty()) return out;
  if (!out.left_out.empty()) return tl::unexpected(out.left_out.front());
  return fail(ErrorCode::bad_input, "none of the files holds anything to play",
              "name the raw-*.raw files of the daemon's runs folder");
}

}  // namespace mgtd::daemon::cli
