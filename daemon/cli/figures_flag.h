// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "calib/report/figures/figure.h"
#include "daemon/cli/command.h"

/// The option --figures[=FOLDER] adds figures to an answer, in its JSON object and as SVG files in a folder.
namespace mgtd::daemon::cli {

struct FiguresFlag {
  std::string given{};  ///< empty: not asked for; "true": in the JSON object only; else the folder
  [[nodiscard]] bool asked() const { return !given.empty(); }
};

void add_figures_flag(CLI::App* command, FiguresFlag& flag);

/// To be called before anything is computed: refuses pictures that nobody would get, and makes the folder.
[[nodiscard]] Result<void> ready_for_figures(const Session& session, const FiguresFlag& flag);

/// Where they were asked for: has them drawn, writes FOLDER/NAME.svg, says so on stderr, and puts "figures"
/// into `out` (figure_words.h).
[[nodiscard]] Result<void> hand_out(const FiguresFlag& flag,
                                    const std::function<std::vector<calib::report::figures::Figure>()>& drawn,
                                    nlohmann::json& out);

}  // namespace mgtd::daemon::cli
