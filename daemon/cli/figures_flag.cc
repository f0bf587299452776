// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/figures_flag.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>

#include "calib/report/figure_words.h"
#include "daemon/cli/output_file.h"

namespace mgtd::daemon::cli {
namespace {

constexpr const char* kInJsonOnly = "true";  // what CLI11 makes of a flag without a value

/// Empty where no folder was named.
std::filesystem::path folder_of(const FiguresFlag& flag) {
  return flag.given == kInJsonOnly ? std::filesystem::path() : std::filesystem::path(flag.given);
}

}  // namespace

void add_figures_flag(CLI::App* command, FiguresFlag& flag) {
  command->add_flag(
      "--figures", flag.given,
      "also: pictures, as SVG in the object of --json; with --figures=FOLDER as files there too");
}

Result<void> ready_for_figures(const Session& session, const FiguresFlag& flag) {
  if (!flag.asked()) return {};
  const std::filesystem::path folder = folder_of(flag);
  if (folder.empty() && !session.json)
    return fail(ErrorCode::usage,
                "--figures puts pictures into the object of --json, which was not asked for",
                "--figures=FOLDER writes them as files");
  if (folder.empty()) return {};
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (!failed) return {};
  return fail(ErrorCode::io,
              fmt::format("the folder {} cannot be made: {}", folder.string(), failed.message()),
              "choose another place with --figures=FOLDER");
}

Result<void> hand_out(const FiguresFlag& flag,
                      const std::function<std::vector<calib::report::figures::Figure>()>& drawn,
                      nlohmann::json& out) {
  if (!flag.asked()) return {};
  const std::vector<calib::report::figures::Figure> figures = drawn();
  out["figures"] = calib::report::figures_json(figures);
  const std::filesystem::path folder = folder_of(flag);
  if (folder.empty()) return {};
  for (const calib::report::figures::Figure& figure : figures) {
    const auto output = OutputFile::at((folder / (figure.name + ".svg")).string(), {}, "--figures");
    if (!output) return tl::unexpected(output.error());
    if (auto written = output->write(figure.svg, fmt::format("figure \"{}\"", figure.title)); !written)
      return written;
  }
  return {};
}

}  // namespace mgtd::daemon::cli
