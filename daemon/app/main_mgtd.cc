// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>
#include <sstream>
#include <string>
#include <utility>

#include "daemon/app/service.h"
#include "daemon/config/config.h"
#include "proto/standard_output.h"
#include "proto/version.h"

namespace {

// sysexits.h, as systemd and scripts know them.
constexpr int kExitUsage = 64, kExitConfig = 78, kExitUnavailable = 69, kExitIo = 74;

int report(const mgtd::Error& error) {
  fmt::print(stderr, "mgtd: {}\n", error.text());
  return error.code == mgtd::ErrorCode::io ? kExitIo : kExitUnavailable;
}

int run(int argc, char** argv) {
  CLI::App app{
      "mgtd: drives a magnetic gradient tensor rig, calibrates it and streams the tensor\n\n"
      "  mgtd --config /etc/mgtd/mgtd.toml                  run\n"
      "  mgtd --config rig.toml --check-config              list every mistake in the configuration and "
      "end\n\n"
      "The operator's tool is mgt: mgt status, mgt run start, mgt watch.",
      "mgtd"};
  app.set_version_flag("--version", mgtd::version());
  std::string config_file = "/etc/mgtd/mgtd.toml";
  bool check_only = false;
  app.add_option("--config", config_file, "the configuration")->capture_default_str();
  app.add_flag("--check-config", check_only, "only read the configuration");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::ostringstream out;
    const int code = app.exit(error, out, std::cerr);
    fmt::print("{}", out.str());
    return code == 0 ? 0 : kExitUsage;
  }
  auto config = mgtd::daemon::config::load_config(config_file);
  if (!config) {
    for (const std::string& line : config.error().lines) fmt::print(stderr, "{}\n", line);
    return kExitConfig;
  }
  if (check_only) {
    for (const std::string& warning : config->warnings) fmt::print(stderr, "{}\n", warning);
    fmt::print("{}: good\n", config_file);
    return 0;
  }
  const auto ended = mgtd::daemon::app::run_service(*std::move(config));
  return ended ? 0 : report(ended.error());
}

}  // namespace

int main(int argc, char** argv) {
  return mgtd::with_standard_output("mgtd", kExitIo, [&] { return run(argc, argv); });
}
