// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "calib/report/report_content.h"

/// The report of a run is one page that needs nothing else: no script, no font, no network.
namespace mgtd::calib::report {

[[nodiscard]] std::string report_page(const ReportContent& content);

[[nodiscard]] std::string figures_html(const std::vector<figures::Figure>& figures);

/// Parts of it, in order.
[[nodiscard]] std::string verdict_section(const ReportContent& content);
[[nodiscard]] std::string measured_section(const ReportContent& content);
[[nodiscard]] std::string noise_section(const ReportContent& content);
[[nodiscard]] std::string limits_section(const ReportContent& content);
[[nodiscard]] std::string rounds_section(const ReportContent& content);
[[nodiscard]] std::string waterfall_section(const ReportContent& content);
[[nodiscard]] std::string residual_section(const ReportContent& content);
[[nodiscard]] std::string candidates_section(const ReportContent& content);
[[nodiscard]] std::string laws_section(const ReportContent& content);
[[nodiscard]] std::string errors_section(const ReportContent& content);
[[nodiscard]] std::string parameters_section(const ReportContent& content);
[[nodiscard]] std::string next_section(const ReportContent& content);
[[nodiscard]] std::string judgements_section(const ReportContent& content);
[[nodiscard]] std::string history_section(const ReportContent& content);

}  // namespace mgtd::calib::report
