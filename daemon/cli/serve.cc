// SPDX-License-Identifier: Apache-2.0
// The workbench on files, without a daemon: mgt serve.
#include <nlohmann/json.hpp>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "daemon/cli/command.h"
#include "daemon/cli/fit_flags.h"
#include "daemon/serve/console/console_server.h"
#include "proto/standard_output.h"
#include "proto/version.h"

namespace mgtd::daemon::cli {
namespace {

constexpr const char* kServeHelp =
    "Serves the workbench on run files (*.mgtrun) and pose tables (*.csv) to a browser on this computer, "
    "with\n"
    "no daemon and no instruments: verdict, nine linked panels, candidates and their evidence; add an "
    "effect\n"
    "and see the error fall, undo, mask poses, try a formula, what to measure next. Every number on the "
    "page\n"
    "comes from a command of mgt, which the page shows beside it.\n\n"
    "  mgt serve                            files of this folder\n"
    "  mgt serve monday.mgtrun              this run\n"
    "  mgt serve runs/ --port 7452          always at the same address\n"
    "  mgt serve poses.csv --field 50000    without a scalar reference\n\n"
    "The address holds a token, which is new each time: whoever opens it may change the models kept in "
    "these\n"
    "files. Other computers are not answered; ssh -L 7452:127.0.0.1:7452 brings the page there. A pose "
    "table\n"
    "keeps no model; the page offers to make a run file of it.\n\n"
    "Ctrl-C ends it. Exit code 0.";

/// Nothing is acquired here: two processors may compute.
constexpr std::size_t kAtOnce = 2;

struct ServeArguments {
  std::string what{"."};
  std::uint16_t port{0};
  std::shared_ptr<FitFlags> flags;
};

/// What the command line says of the field and the array, for every job.
std::vector<std::string> model_options(const FitFlags& f) {
  FitFlags from_anywhere = f;
  if (!f.array.array.empty()) from_anywhere.array.array = std::filesystem::absolute(f.array.array).string();
  std::vector<std::string> out;
  for (const auto& [name, value] : field_options(from_anywhere)) out.push_back(name + "=" + value);
  return out;
}

std::string hello(const ServeArguments& args, bool one) {
  std::error_code ec;
  const auto path = std::filesystem::canonical(args.what, ec);
  return nlohmann::json{{"software", std::string("mgt ") + version()},
                        {"mode", "files"},
                        {"rig", path.filename().string()},
                        {"path", path.string()},
                        {"run", one ? nlohmann::json(path.filename().string()) : nlohmann::json()}}
      .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

int run_serve(const Session& session, const ServeArguments& args) {
  namespace fs = std::filesystem;
  std::error_code ec;
  const bool one = fs::is_regular_file(args.what, ec);
  const std::string extension = fs::path(args.what).extension().string();
  if (!one && !fs::is_directory(args.what, ec))
    return print_error(session, {ErrorCode::bad_input, args.what + " is no run and no folder",
                                 "name a *.mgtrun, a pose table in CSV, or a folder of them"});
  if (one && extension != ".mgtrun" && extension != ".csv")
    return print_error(session, {ErrorCode::bad_input, args.what + " is neither *.mgtrun nor *.csv",
                                 "mgt import makes a run file of other tables"});
  spdlog::set_level(spdlog::level::warn);
  std::signal(SIGPIPE, SIG_IGN);
  boost::asio::io_context io(1);
  serve::console::ConsoleSource source;
  source.hello = [&] { return hello(args, one); };
  serve::console::ConsoleServer server(
      io,
      {.listen = fmt::format("127.0.0.1:{}", args.port),
       .workbench =
           serve::console::WorkbenchConfig{
               .runs = args.what,
               .mgt = serve::console::mgt_beside_us(),
               .model_options = model_options(*args.flags),
               .limits = {.at_once = kAtOnce},
               .bounds = {.memory_bytes = serve::console::memory_bytes() / 2 / kAtOnce}}},
      std::move(source));
  if (auto started = server.start(); !started)
    return print_error(session, {started.error().code, started.error().message,
                                 "choose another port with --port; 0 takes a free one"});
  const std::string url = server.address() + "#token=" + server.token().text();
  if (session.json) {
    print_json({{"address", server.address()}, {"token", server.token().text()}, {"url", url}});
  } else {
    fmt::print("{}\n", url);
    fmt::print(stderr, "open this address in a browser on this computer; Ctrl-C ends\n");
  }
  flush_standard_output();
  boost::asio::signal_set signals(io, SIGINT, SIGTERM, SIGHUP);
  signals.async_wait([&](auto failed, int) {
    if (failed) return;
    server.stop();
    io.stop();
  });
  io.run();
  return 0;
}

}  // namespace

void add_serve(CLI::App& app, Session& session) {
  auto args = std::make_shared<ServeArguments>();
  CLI::App* const command =
      add_command(app, session, "serve", "the workbench in a browser, on files, without a daemon",
                  [args, &session] { return run_serve(session, *args); });
  command->footer(kServeHelp);
  command->add_option("RUN|DIR", args->what, "*.mgtrun, a pose table in CSV, or a folder of them")
      ->capture_default_str();
  command->add_option("--port", args->port, "of 127.0.0.1; 0 takes a free one")->capture_default_str();
  args->flags = add_current_model_flags(command);
}

}  // namespace mgtd::daemon::cli
