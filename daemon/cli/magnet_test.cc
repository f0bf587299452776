// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <csignal>
#include <nlohmann/json.hpp>
#include <thread>

#include "daemon/cli/ask.h"
#include "daemon/cli/interrupt.h"

namespace mgtd::daemon::cli {
namespace {

int print_end(const Session& session, const nlohmann::json& status) {
  if (session.json) print_json(status);
  fmt::print(stderr, "{}\n", status.at("text").get<std::string>());
  if (!session.json) {
    for (const auto& finding : status.at("findings")) fmt::print("{}\n", finding.get<std::string>());
  }
  return status.at("right") == true ? 0 : 1;
}

/// Tells the operator what to do until the daemon has seen all arms or gives up.
int run_magnet_test(const Session& session) {
  auto client = serve::ControlClient::connect(session.control_socket);
  if (!client) return print_error(session, client.error());
  catch_interrupts({SIGINT, SIGTERM, SIGHUP});
  auto status = client->request(ControlCommand::magnet_start);
  std::string told;
  while (status && status->at("active") == true) {
    if (const std::string text = status->at("text"); text != told) fmt::print(stderr, "{}\n", text);
    told = status->at("text");
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    status = client->request(interrupted() ? ControlCommand::magnet_stop : ControlCommand::magnet_status);
  }
  return status ? print_end(session, *status) : print_error(session, status.error());
}

}  // namespace

void add_magnet_test(CLI::App& run, Session& session) {
  add_command(
      run, session, "magnet-test",
      "which sensor is on which arm? Hold a magnet to one arm after the other as you are told; exit code "
      "0: every cable is on its arm",
      [&session] { return run_magnet_test(session); });
}

}  // namespace mgtd::daemon::cli
