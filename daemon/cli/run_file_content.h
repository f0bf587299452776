// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "calib/report/report_content.h"
#include "daemon/run/run_judgement.h"
#include "daemon/store/model_history.h"
#include "daemon/store/pose_source.h"

/// run_file_content() puts what a run file keeps beside its poses into the words and tables of the report.
namespace mgtd::daemon::cli {

[[nodiscard]] calib::report::RunFileContent run_file_content(const store::PoseSource& source,
                                                             const std::vector<run::RunJudgement>& judgements,
                                                             const std::vector<store::ModelStep>& history);

}  // namespace mgtd::daemon::cli
