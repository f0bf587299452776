// SPDX-License-Identifier: Apache-2.0
#include "daemon/acquire/replay.h"

#include <fmt/format.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>

#include "daemon/cli/calibration_file.h"
#include "daemon/cli/command.h"
#include "daemon/cli/journal_files.h"
#include "daemon/cli/output_file.h"
#include "daemon/cli/work_progress.h"

namespace mgtd::daemon::cli {
namespace {

struct ReplayArguments {
  std::vector<std::string> journals;
  std::string calibration, output;
};

/// Where the lines go.
struct ReplayOutput {
  std::FILE* file{nullptr};  ///< null: nowhere
  std::uint64_t failed{0};

  void write(std::string_view line) {
    if (file == nullptr) return;
    if (file == stdout) return fmt::print("{}\n", line);
    const bool whole =
        std::fwrite(line.data(), 1, line.size(), file) == line.size() && std::fputc('\n', file) != EOF;
    failed += whole ? 0 : 1;
  }
};

/// Shows how much of the journals is played; nothing where the lines themselves go to the terminal.
class PlayProgress {
 public:
  PlayProgress(const std::vector<std::string>& journals, bool to_terminal) {
    for (const std::string& path : journals) {
      std::error_code unknown;
      const auto bytes = std::filesystem::file_size(path, unknown);
      if (!unknown) total_ += static_cast<double>(bytes);
    }
    if (!to_terminal) shown_.emplace("replay");
  }
  void played(std::uint64_t bytes) {
    bytes_ += static_cast<double>(bytes);
    if (shown_ && total_ > 0) shown_->done(bytes_ / total_);
  }

 private:
  double total_{0}, bytes_{0};
  std::optional<WorkProgress> shown_;
};

/// How many bytes could not be read because they are damaged. A last record that is cut short because the
/// daemon was killed does not count as damage.
Result<std::uint64_t> play(const std::string& path, acquire::Replay& replay, PlayProgress& progress) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return fail(ErrorCode::bad_input, path + ": cannot be read", "check path and permissions");
  RawLogDecoder decoder;
  std::uint64_t bytes = 0;
  std::string piece(1U << 20U, '\0');
  while (in.read(piece.data(), static_cast<std::streamsize>(piece.size())), in.gcount() > 0) {
    decoder.feed(std::string_view(piece).substr(0, static_cast<std::size_t>(in.gcount())));
    bytes += static_cast<std::uint64_t>(in.gcount());
    while (const auto record = decoder.next()) {
      if (auto fed = replay.feed(*record); !fed) {
        fed.error().message = path + ": " + fed.error().message;
        return tl::unexpected(std::move(fed.error()));
      }
    }
    progress.played(static_cast<std::uint64_t>(in.gcount()));
  }
  if (in.bad())
    return fail(ErrorCode::io, fmt::format("{}: cannot be read beyond byte {}", path, bytes),
                "check the disk; what stands before was played");
  if (const auto whole = decoder.finish(); !whole) fmt::print(stderr, "{}: {}\n", path, whole.error().text());
  const std::uint64_t unread = bytes - std::min(bytes, decoder.good_bytes());
  return decoder.state() == RawLogDecoder::State::damaged || unread > kRawRecordMax ? unread : 0;
}

nlohmann::json summary(const acquire::ReplayCounts& counts, const std::vector<Error>& left_out,
                       std::uint64_t damaged) {
  auto not_played = nlohmann::json::array();
  for (const Error& why : left_out) not_played.push_back({{"message", why.message}, {"remedy", why.remedy}});
  return {{"schema", "mgt.replay/1"},
          {"lives", counts.lives},
          {"records", counts.records},
          {"samples", counts.samples},
          {"gaps", counts.gaps},
          {"missing", counts.missing},
          {"bytes_lost", counts.bytes_lost},
          {"bytes_damaged", damaged},
          {"not_played", std::move(not_played)},
          {"parted", counts.parted ? nlohmann::json(*counts.parted) : nlohmann::json()}};
}

void print_summary(const acquire::ReplayCounts& counts, std::uint64_t damaged) {
  fmt::print(stderr, "{} samples, {} missing in {} gaps, from {} start{} of the daemon\n", counts.samples,
             counts.missing, counts.gaps, counts.lives, counts.lives == 1 ? "" : "s");
  if (counts.bytes_lost > 0)
    fmt::print(stderr,
               "{} bytes are missing from the journal, because the disk refused them: after them the stream "
               "may differ from what it was\n",
               counts.bytes_lost);
  if (damaged > 0)
    fmt::print(
        stderr,
        "{} bytes are damaged or follow damage in their file, and were not read: the stream differs from "
        "what it was from there on\n  play an undamaged copy\n",
        damaged);
  if (counts.parted)
    fmt::print(stderr,
               "the replay differs from what happened: {}\n  use the version of mgt that wrote the journal\n",
               *counts.parted);
}

int run_replay(const Session& session, const ReplayArguments& args) {
  const auto journals = journals_of(args.journals);
  if (!journals) return print_error(session, journals.error());
  for (const Error& why : journals->left_out) fmt::print(stderr, "{}\n", why.text());
  std::vector<std::string> read = journals->play;
  read.push_back(args.calibration);
  const auto place = OutputFile::at(args.output, read);
  if (!place) return print_error(session, place.error());
  std::shared_ptr<const calib::calibration::Calibration> instead;
  if (!args.calibration.empty()) {
    auto calibration = read_calibration(args.calibration);
    if (!calibration) return print_error(session, calibration.error());
    instead = std::make_shared<const calib::calibration::Calibration>(*std::move(calibration));
  }
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(nullptr, &std::fclose);
  const bool printed = place->wanted() && place->is_standard_output();
  ReplayOutput output{session.json && !printed ? nullptr : stdout};
  if (place->wanted() && !printed) {
    file.reset(std::fopen(args.output.c_str(), "we"));
    if (file == nullptr)
      return print_error(
          session, {ErrorCode::io, args.output + ": cannot be written", "check the folder and the disk"});
    output.file = file.get();
  }
  acquire::Replay replay([&output](std::string_view line) { output.write(line); }, instead);
  std::uint64_t damaged = 0;
  {
    PlayProgress progress(journals->play, output.file == stdout && isatty(STDOUT_FILENO) != 0);
    for (const std::string& path : journals->play) {
      const auto unread = play(path, replay, progress);
      if (!unread) return print_error(session, unread.error());
      damaged += *unread;
    }
  }
  if (file && (std::fflush(file.get()) != 0 || output.failed > 0))
    return print_error(session, {ErrorCode::io, "not every line could be written", "free space on the disk"});
  if (printed) end_standard_output();
  if (place->wanted()) tell_written("stream", args.output);
  if (session.json) print_json(summary(replay.counts(), journals->left_out, damaged));
  if (!session.json) print_summary(replay.counts(), damaged);
  return replay.counts().parted || damaged > 0 ? 1 : 0;
}

}  // namespace

void add_replay(CLI::App& app, Session& session) {
  auto args = std::make_shared<ReplayArguments>();
  CLI::App* const command = add_command(
      app, session, "replay", "reproduce the stream byte for byte from the daemon's raw journal (NDJSON)",
      [args, &session] { return run_replay(session, *args); });
  command
      ->add_option("JOURNAL", args->journals,
                   "raw-*.raw, beginning with the first file of a start of the daemon")
      ->required();
  command->add_option("--cal", args->calibration,
                      "use this CAL.json throughout, instead of those that were active");
  command->add_option("-o,--output", args->output, "file; standard output when absent");
}

}  // namespace mgtd::daemon::cli
