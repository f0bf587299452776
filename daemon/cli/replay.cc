// SPDX-License-Identifier: Apache-2.0
#include "daemon/replay.h"

#include <fmt/format.h>

#include <algorithm>
#include <compare>
#include <cstdio>
#include <fstream>
#include <memory>

#include "daemon/cli/calibration_file.h"
#include "daemon/cli/command.h"

namespace mgtd::cli {
namespace {

struct Arguments {
  std::vector<std::string> journals;
  std::string calibration, output;
};

/// More than any header: its text has at most 65 535 bytes.
constexpr std::size_t kHeaderMost = 66'000;

/// Where the lines go.
struct Output {
  std::FILE* file{nullptr};  ///< null: nowhere
  std::uint64_t failed{0};

  void write(std::string_view line) {
    if (file == nullptr) return;
    const bool whole =
        std::fwrite(line.data(), 1, line.size(), file) == line.size() && std::fputc('\n', file) != EOF;
    failed += whole ? 0 : 1;
  }
};

/// "raw-01795255200.000003": the life, and the file's number in it.
std::pair<std::string, std::uint64_t> life_and_number(const std::string& name) {
  const std::size_t dot = name.rfind('.');
  if (dot == std::string::npos) return {name, 0};
  return {name.substr(0, dot), std::strtoull(name.c_str() + dot + 1, nullptr, 10)};
}

/// A journal file and what it says of its place among the others.
struct JournalFile {
  std::string life;
  std::uint64_t number{0};
  std::string path;
  auto operator<=>(const JournalFile&) const = default;
};

/// Empty: the crash that ended it came before its header was whole.
Result<std::optional<JournalFile>> header_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return fail(ErrorCode::bad_input, path + ": cannot be read", "check path and permissions");
  std::string piece(kHeaderMost, '\0');
  in.read(piece.data(), static_cast<std::streamsize>(piece.size()));
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

/// In the order they were written.
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
  if (out.empty()) {
    return fail(ErrorCode::bad_input, "none of the files holds anything to play",
                "name the raw-*.raw files of the daemon's runs folder");
  }
  std::sort(out.begin(), out.end());
  return out;
}

/// Plays one file after another and sees that none between is missing.
class Player {
 public:
  explicit Player(daemon::Replay& replay) : replay_(replay) {}

  [[nodiscard]] Result<void> play(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    if (!in) return fail(ErrorCode::bad_input, path + ": cannot be read", "check path and permissions");
    RawLogDecoder decoder;
    std::string piece(1U << 20U, '\0');
    bool begun = false;
    while (in.read(piece.data(), static_cast<std::streamsize>(piece.size())), in.gcount() > 0) {
      decoder.feed(std::string_view(piece).substr(0, static_cast<std::size_t>(in.gcount())));
      for (auto record = decoder.next(); begun || decoder.state() == RawLogDecoder::State::records;
           record = decoder.next()) {
        if (!std::exchange(begun, true)) {
          if (auto follows = begin(path, decoder.header()); !follows) return follows;
        }
        if (!record) break;
        if (auto fed = replay_.feed(*record); !fed) {
          fed.error().message = path + ": " + fed.error().message;
          return fed;
        }
      }
    }
    if (const auto whole = decoder.finish(); !whole)
      fmt::print(stderr, "{}: {}\n", path, whole.error().text());
    return {};
  }

 private:
  [[nodiscard]] Result<void> begin(const std::string& path, const RawLogHeader& header) {
    const auto [life, number] = life_and_number(header.run_id);
    const bool follows = life == life_ ? number == number_ + 1 : number == 0;
    if (!follows) {
      return fail(ErrorCode::bad_input,
                  fmt::format("{}: file {} of its journal, and {} is not named before it", path, number,
                              life == life_ ? fmt::format("file {}", number_ + 1) : "its first file, 0,"),
                  "name every file of the journal once, from its first one on");
    }
    life_ = life;
    number_ = number;
    return {};
  }

  daemon::Replay& replay_;
  std::string life_;
  std::uint64_t number_{0};
};

nlohmann::json summary(const daemon::ReplayCounts& counts) {
  return {{"schema", "mgt.replay/1"},
          {"lives", counts.lives},
          {"records", counts.records},
          {"samples", counts.samples},
          {"gaps", counts.gaps},
          {"missing", counts.missing},
          {"bytes_lost", counts.bytes_lost},
          {"parted", counts.parted ? nlohmann::json(*counts.parted) : nlohmann::json()}};
}

void print_summary(const daemon::ReplayCounts& counts) {
  fmt::print(stderr, "{} samples, {} missing in {} gaps, from {} start{} of the daemon\n", counts.samples,
             counts.missing, counts.gaps, counts.lives, counts.lives == 1 ? "" : "s");
  if (counts.bytes_lost > 0)
    fmt::print(stderr,
               "{} bytes are not in the journal, because the disk refused: after them the stream may "
               "differ from what it was\n",
               counts.bytes_lost);
  if (counts.parted)
    fmt::print(stderr, "this is not how it went: {}\n  use the version of mgt that wrote the journal\n",
               *counts.parted);
}

int run_replay(const Session& session, const Arguments& args) {
  const auto journals = in_order(args.journals);
  if (!journals) return report(session, journals.error());
  std::shared_ptr<const calib::Calibration> instead;
  if (!args.calibration.empty()) {
    auto calibration = read_calibration(args.calibration);
    if (!calibration) return report(session, calibration.error());
    instead = std::make_shared<const calib::Calibration>(*std::move(calibration));
  }
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(nullptr, &std::fclose);
  Output output{session.json ? nullptr : stdout};
  if (!args.output.empty()) {
    file.reset(std::fopen(args.output.c_str(), "we"));
    if (file == nullptr)
      return report(session,
                    {ErrorCode::io, args.output + ": cannot be written", "check the folder and the disk"});
    output.file = file.get();
  }
  daemon::Replay replay([&output](std::string_view line) { output.write(line); }, instead);
  Player player(replay);
  for (const JournalFile& journal : *journals) {
    if (auto played = player.play(journal.path); !played) return report(session, played.error());
  }
  if (output.file != nullptr && (std::fflush(output.file) != 0 || output.failed > 0))
    return report(session, {ErrorCode::io, "not every line could be written", "free space on the disk"});
  if (session.json) print_json(summary(replay.counts()));
  if (!session.json) print_summary(replay.counts());
  return replay.counts().parted ? 1 : 0;
}

}  // namespace

void add_replay(CLI::App& app, Session& session) {
  auto args = std::make_shared<Arguments>();
  CLI::App* const command =
      add_command(app, session, "replay",
                  "the stream once more, to the last byte, from the daemon's raw journal (NDJSON)",
                  [args, &session] { return run_replay(session, *args); });
  command->add_option("JOURNAL", args->journals, "raw-*.raw, from the first file of a start of the daemon on")
      ->required();
  command->add_option("--cal", args->calibration,
                      "this CAL.json all along, instead of those that were active");
  command->add_option("-o,--output", args->output, "file; standard output when absent");
}

}  // namespace mgtd::cli
