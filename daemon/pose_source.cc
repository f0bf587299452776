// SPDX-License-Identifier: Apache-2.0
#include "daemon/pose_source.h"

#include <fstream>
#include <string>

#include "calib/pose_table.h"
#include "daemon/durable_file.h"
#include "daemon/run_file.h"

namespace mgtd::daemon {
namespace {

constexpr std::string_view kSqliteMagic{"SQLite format 3\0", 16};

bool is_database(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::string start(kSqliteMagic.size(), '\0');
  in.read(start.data(), static_cast<std::streamsize>(start.size()));
  return in && start == kSqliteMagic;
}

}  // namespace

Result<PoseSource> read_run(const std::filesystem::path& path) {
  if (is_database(path) || path.extension() == ".mgtrun") {
    auto file = RunFile::open(path, Access::read_only);
    if (!file) return tl::unexpected(file.error());
    auto table = file->poses();
    if (!table) return tl::unexpected(table.error());
    const auto steps = file->model_steps();
    if (!steps) return tl::unexpected(steps.error());
    PoseSource out{std::move(*table), file->header(), kept_model(*steps), {}};
    const auto formulas = file->document(kFormulasDocument);
    if (!formulas) return tl::unexpected(formulas.error());
    if (!*formulas) return out;
    auto definitions = definitions_from_text(**formulas);
    if (!definitions) {
      definitions.error().message = path.string() + ": " + definitions.error().message;
      return tl::unexpected(definitions.error());
    }
    out.definitions = std::move(*definitions);
    return out;
  }
  const auto text = read_file(path);
  if (!text) return tl::unexpected(text.error());
  auto table = calib::parse_pose_table(*text, path.string());
  if (!table) return tl::unexpected(table.error());
  return PoseSource{std::move(*table), std::nullopt, {}, {}};
}

Result<PoseTable> read_poses(const std::filesystem::path& path) {
  auto source = read_run(path);
  if (!source) return tl::unexpected(source.error());
  return std::move(source->table);
}

}  // namespace mgtd::daemon
