// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>

int main(int argc, char** argv) {
  CLI::App app{"mgtd: acquires, calibrates and streams the magnetic gradient tensor"};
  app.set_version_flag("--version", MGTD_VERSION);
  CLI11_PARSE(app, argc, argv);
  return 0;
}
