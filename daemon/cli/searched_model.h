// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "calib/effects/effect.h"
#include "calib/report/discovery_report.h"
#include "daemon/store/pose_source.h"

namespace mgtd::daemon::cli {

/// commands_to_model() lists the commands that turn the model kept in a run into the one beside which a law
/// was searched: `mgt drop` for what was not in it, `mgt add` for what was. A law is added to the kept model,
/// and without the others it is not the law that was found. There are none where the two are the same.
/// `run` as the person typed it; a pose table is made a run file first.
[[nodiscard]] calib::report::CommandsToModel commands_to_model(
    const std::vector<calib::effects::EffectPtr>& searched, const store::PoseSource& source,
    const std::string& run);

}  // namespace mgtd::daemon::cli
