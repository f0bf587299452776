// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "daemon/cli/command.h"
#include "daemon/config/config.h"

namespace mgtd::daemon::cli {

void add_check_config(CLI::App& app, Session& session) {
  const auto file = std::make_shared<std::string>();
  CLI::App* const command = add_command(
      app, session, "check-config", "read a configuration and list every mistake in it", [file, &session] {
        const auto config = config::load_config(*file);
        if (config) {
          for (const std::string& warning : config->warnings) fmt::print(stderr, "{}\n", warning);
          if (session.json) {
            print_json({{"schema", "mgt.check-config/1"},
                        {"ok", true},
                        {"errors", nlohmann::json::array()},
                        {"warnings", config->warnings}});
          } else {
            fmt::print("{}: good\n", *file);
          }
          return 0;
        }
        for (const std::string& line : config.error().lines) fmt::print(stderr, "{}\n", line);
        if (session.json) {
          print_json({{"schema", "mgt.check-config/1"}, {"ok", false}, {"errors", config.error().lines}});
        }
        return 2;
      });
  command->add_option("FILE", *file, "the configuration")->required();
}

}  // namespace mgtd::daemon::cli
