// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/pose_source.h"

#include <algorithm>
#include <fstream>
#include <string>

#include "calib/poses/joined_runs.h"
#include "calib/poses/pose_table.h"
#include "daemon/store/durable_file.h"
#include "daemon/store/run_file.h"
#include "daemon/store/same_array.h"

namespace mgtd::daemon::store {
namespace {

constexpr std::string_view kSqliteMagic{"SQLite format 3\0", 16};

bool is_database(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::string start(kSqliteMagic.size(), '\0');
  in.read(start.data(), static_cast<std::streamsize>(start.size()));
  return in && start == kSqliteMagic;
}

void leave_out_masked(PoseSource& source) {
  std::erase_if(source.table.poses, [&](const Pose& pose) {
    return std::any_of(source.masked.begin(), source.masked.end(),
                       [&](const MaskedPose& m) { return m.number == pose.number; });
  });
}

}  // namespace

bool is_run_file(const std::filesystem::path& path) {
  return is_database(path) || path.extension() == ".mgtrun";
}

Result<PoseSource> read_run(const std::filesystem::path& path, Masked masked) {
  if (is_run_file(path)) {
    auto file = RunFile::open(path, Access::read_only);
    if (!file) return tl::unexpected(file.error());
    auto table = file->poses();
    if (!table) return tl::unexpected(table.error());
    const auto steps = file->model_steps();
    if (!steps) return tl::unexpected(steps.error());
    PoseSource out{std::move(*table), file->header(), current_model(*steps), {}, masked_poses(*steps)};
    if (masked == Masked::left_out) leave_out_masked(out);
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
  auto table = calib::poses::parse_pose_table(*text, path.string());
  if (!table) return tl::unexpected(table.error());
  return PoseSource{std::move(*table), std::nullopt, {}, {}, {}};
}

Result<PoseSource> read_runs(const std::filesystem::path& first, const std::vector<std::string>& others) {
  auto out = read_run(first);
  for (const std::string& path : others) {
    if (!out) return out;
    const auto other = read_run(path);
    if (!other) return tl::unexpected(other.error());
    if (out->header && other->header) {
      const PlacedFile a{first.string(), out->header->options.geometry},
          b{path, other->header->options.geometry};
      if (auto same = same_array(a, b, "judge them one by one"); !same) return tl::unexpected(same.error());
    }
    auto both = calib::poses::joined(out->table, other->table);
    if (!both) return tl::unexpected(both.error());
    out->table = std::move(*both);
  }
  return out;
}

Result<PoseTable> read_poses(const std::filesystem::path& path) {
  auto source = read_run(path, Masked::kept);
  if (!source) return tl::unexpected(source.error());
  return std::move(source->table);
}

}  // namespace mgtd::daemon::store
