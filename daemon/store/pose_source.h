// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "daemon/store/model_history.h"
#include "daemon/store/run_header.h"
#include "daemon/store/user_formulas.h"
#include "proto/error.h"
#include "proto/pose.h"

/// The RUN argument of every offline command names a run file or a pose table in CSV; the content tells
/// which.
namespace mgtd::daemon::store {

struct PoseSource {
  PoseTable table;
  std::optional<RunHeader> header;        ///< of a run file
  std::vector<std::string> model{};       ///< kept in a run file: specs of effects
  std::vector<Definition> definitions{};  ///< formulas kept in a run file
  std::vector<MaskedPose> masked{};       ///< of a run file
};

/// Whether the file holds a run or is called like one (*.mgtrun).
[[nodiscard]] bool is_run_file(const std::filesystem::path& path);

/// Whether poses that an operator masked stand in the table.
enum class Masked { left_out, kept };

[[nodiscard]] Result<PoseSource> read_run(const std::filesystem::path& path,
                                          Masked masked = Masked::left_out);
/// The first run with the poses of the others (calib/poses/joined_runs.h); its own header, model and formulas
/// count. Refuses runs whose sensors stand at other places.
[[nodiscard]] Result<PoseSource> read_runs(const std::filesystem::path& first,
                                           const std::vector<std::string>& others);
/// Every pose of the file, masked ones too: for what copies or converts and does not judge.
[[nodiscard]] Result<PoseTable> read_poses(const std::filesystem::path& path);

}  // namespace mgtd::daemon::store
