// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "calib/criticism/search/choice.h"
#include "calib/criticism/search/explain.h"
#include "calib/criticism/search/waterfall.h"
#include "calib/criticism/tests/comparison.h"
#include "calib/fit/method_choice/fit.h"
#include "daemon/store/model_history.h"
#include "daemon/store/pose_source.h"

/// The report of a run is one page that needs nothing else: no script, no font, no network.
namespace mgtd::daemon::cli {

struct ReportContent {
  std::string run;  ///< file name
  store::PoseSource source;
  calib::fit::FitReport fit;
  calib::criticism::tests::Comparison comparison;
  calib::criticism::search::ExplainReport explained;
  std::optional<calib::criticism::search::Waterfall> waterfall;  ///< of a model with effects
  std::vector<store::ModelStep> history;
  std::vector<calib::criticism::search::Choice> doubts;  ///< what is open about effects of the kept model
  std::string command;                                   ///< that makes this report again
};

[[nodiscard]] std::string report_page(const ReportContent& content);

/// Parts of it, in order.
[[nodiscard]] std::string measured_section(const ReportContent& content);
[[nodiscard]] std::string verdict_section(const ReportContent& content);
[[nodiscard]] std::string errors_section(const ReportContent& content);
[[nodiscard]] std::string residual_section(const ReportContent& content);
[[nodiscard]] std::string waterfall_section(const ReportContent& content);
[[nodiscard]] std::string candidates_section(const ReportContent& content);
[[nodiscard]] std::string limits_section(const ReportContent& content);
[[nodiscard]] std::string parameters_section(const ReportContent& content);
[[nodiscard]] std::string history_section(const ReportContent& content);

}  // namespace mgtd::daemon::cli
