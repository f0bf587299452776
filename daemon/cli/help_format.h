// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace mgtd::daemon::cli {

/// HelpFormat writes --help as CLI11 does, with two corrections: options that are not shown (group "") leave
/// no empty line behind, and an argument that may be given up to twice is [EFFECT [EFFECT]], not
/// [EFFECT(0x)].
class HelpFormat : public CLI::Formatter {
 public:
  [[nodiscard]] std::string make_help(const CLI::App* app, std::string name,
                                      CLI::AppFormatMode mode) const override;
  [[nodiscard]] std::string make_option_usage(const CLI::Option* option) const override;
};

}  // namespace mgtd::daemon::cli
