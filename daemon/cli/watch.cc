// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <unistd.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>

#include "daemon/cli/ask.h"
#include "daemon/cli/gap_line.h"
#include "daemon/cli/gap_pace.h"
#include "daemon/cli/in_range.h"
#include "daemon/cli/progress.h"
#include "daemon/cli/sample_line.h"
#include "daemon/cli/watch_panel.h"
#include "daemon/serve/stream_reader.h"
#include "proto/standard_output.h"

namespace mgtd::daemon::cli {
namespace {

struct WatchArguments {
  std::string stream;
  std::optional<double> rate_hz;
  std::uint64_t count{0};
  bool raw{false}, lines{false};
};

/// Gaps that follow each other are one line. On a terminal it is rewritten in place. Elsewhere it is printed
/// when samples come again; while none come, with the count so far, as often as GapPace allows.
class Gaps {
 public:
  void add(const nlohmann::json& gap) {
    if (line_.empty()) pace_.begin(std::chrono::steady_clock::now());
    line_.add(gap.at("from_seq").get<std::uint64_t>(), gap.at("to_seq").get<std::uint64_t>(),
              gap.at("why").get<std::string>());
    if (!terminal_) return mention_when_due();
    const auto width = static_cast<std::size_t>(std::max(20, terminal_width(STDOUT_FILENO) - 1));
    fmt::print("\r{}\x1b[K", indented().substr(0, width));
    flush_standard_output();
  }
  /// Samples come again, or something else is to be printed below.
  void end() {
    if (line_.empty()) return;
    fmt::print("{}\n", terminal_ ? std::string() : indented());
    flush_standard_output();
    line_.clear();
  }
  void mention_when_due() {
    const Instant now = std::chrono::steady_clock::now();
    if (terminal_ || line_.empty() || !pace_.due(now)) return;
    pace_.mention(now);
    fmt::print("{}, and no sample has come since\n", indented());
    flush_standard_output();
  }

 private:
  [[nodiscard]] std::string indented() const { return "              " + line_.text(); }

  bool terminal_{isatty(STDOUT_FILENO) != 0};
  GapLine line_;
  GapPace pace_;
};

/// Prints what the daemon says of the active calibration, each time that it changes from `shown`.
void print_criticism(const nlohmann::json& status, std::string& shown, Gaps& gaps) {
  const auto& criticism = status.at("criticism");
  const std::string state = criticism.at("state");
  if (state == shown) return;
  shown = state;
  if (state != "suspect" && state != "near source") return;
  gaps.end();
  fmt::print("              {}: {}\n              limit: {}; {}\n", state,
             criticism.at("measured").get<std::string>(), criticism.at("limit").get<std::string>(),
             criticism.at("remedy").get<std::string>());
}

/// The address of the stream: the one on the command line, else the one that the daemon states.
Result<std::string> stream_of(const Session& session, const WatchArguments& args) {
  if (!args.stream.empty()) return args.stream;
  const auto version = ask(session, ControlCommand::version);
  if (!version) return tl::unexpected(version.error());
  const std::string unix_path = version->at("stream_unix");
  return unix_path.empty() ? version->at("stream_tcp").get<std::string>() : unix_path;
}

/// Prints one object of the stream for a person.
void show(const nlohmann::json& object, std::string& criticism, Gaps& gaps) {
  const std::string kind = object.at("class");
  if (kind == "TENSOR") {
    gaps.end();
    fmt::print("{}\n", sample_line(object));
    flush_standard_output();
  } else if (kind == "STATUS") {
    print_criticism(object, criticism, gaps);
    gaps.mention_when_due();
  } else if (kind == "GAP") {
    gaps.add(object);
  }
}

Result<serve::StreamReader> open_stream(const Session& session, const WatchArguments& args) {
  const auto where = stream_of(session, args);
  if (!where) return tl::unexpected(where.error());
  WatchRequest request;
  request.classes = {};
  request.classes.add(StreamClass::tensor);
  request.classes.add(StreamClass::status);
  if (session.json || args.raw) request.classes = StreamClasses::all();
  request.rate_hz = args.rate_hz;
  return serve::StreamReader::open(*where, request);
}

/// Draws the panel over the one before, on the terminal behind stdout.
class PanelScreen {
 public:
  void take(const Session& session, const nlohmann::json& object) {
    panel_.take(object);
    const TextLook look = stdout_look(session);
    const std::string text = top_of(shown(panel_.text(terminal_width(STDOUT_FILENO)), look),
                                    static_cast<std::size_t>(terminal_rows(STDOUT_FILENO)));
    fmt::print("{}{}", back_over(drawn_), text);
    flush_standard_output();
    drawn_ = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  }

 private:
  WatchPanel panel_;
  std::size_t drawn_{0};  ///< lines
};

/// How the objects are shown.
enum class WatchForm { panel, lines, objects };

WatchForm form_of(const Session& session, const WatchArguments& args) {
  if (session.json || args.raw) return WatchForm::objects;
  return args.lines || isatty(STDOUT_FILENO) == 0 ? WatchForm::lines : WatchForm::panel;
}

int run_watch(const Session& session, const WatchArguments& args) {
  auto reader = open_stream(session, args);
  if (!reader) return print_error(session, reader.error());
  const WatchForm form = form_of(session, args);
  std::string criticism;
  Gaps gaps;
  PanelScreen screen;
  for (std::uint64_t seen = 0; args.count == 0 || seen < args.count;) {
    const auto object = reader->next(std::chrono::seconds(30));
    if (!object || !*object) {
      gaps.end();
      return print_error(session, object ? Error{ErrorCode::unreachable, "the stream is silent for 30 s",
                                                 "mgt status says why"}
                                         : object.error());
    }
    if (form == WatchForm::objects) {
      print_json(**object);
      flush_standard_output();
    } else if (form == WatchForm::lines) {
      show(**object, criticism, gaps);
    } else {
      screen.take(session, **object);
    }
    if ((*object)->at("class") == "TENSOR") ++seen;
  }
  return 0;
}

}  // namespace

void add_watch(CLI::App& app, Session& session) {
  auto args = std::make_shared<WatchArguments>();
  args->rate_hz = 2;
  CLI::App* const command = add_command(app, session, "watch", "the live stream",
                                        [args, &session] { return run_watch(session, *args); });
  command->add_option("--rate", args->rate_hz, "samples a second")
      ->check(in_range(kWatchRateMin_hz, kWatchRateMax_hz, "Hz"))
      ->capture_default_str();
  command->add_option("--count", args->count, "end after this many samples (0: never)")
      ->check(in_range(0, 1e15, "samples"))
      ->capture_default_str();
  command->add_option("--stream", args->stream, "Unix socket or host:port; default: what the daemon says");
  command->add_flag("--lines", args->lines,
                    "a line for each sample instead of a panel that changes in place");
  command->add_flag("--raw", args->raw, "the objects as they come, one per line");
}

}  // namespace mgtd::daemon::cli
