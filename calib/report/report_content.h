// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "calib/criticism/search/choice.h"
#include "calib/criticism/search/explain_report.h"
#include "calib/criticism/tests/comparison.h"
#include "calib/fit/fit_report.h"
#include "calib/report/figures/figure.h"
#include "calib/report/law_pages.h"
#include "proto/instrument_identity.h"
#include "proto/pose.h"

/// ReportContent holds everything that the report of a run shows, as values and drawn figures.
namespace mgtd::calib::report {

/// What a run file tells beside its poses; empty for a pose table.
struct RunFileContent {
  std::string run{};                ///< its name, its rig and when it started
  figures::DataTable masked{};      ///< poses that an operator left out
  figures::DataTable judgements{};  ///< what a run that went on until it was explained said and did
  figures::DataTable history{};     ///< steps of the model
};

/// In the order of the page.
struct ReportFigures {
  std::vector<figures::Figure> measured{}, panels{}, falls{}, candidates{}, limits{}, prices{}, earlier{};
};

struct ReportContent {
  std::string run;  ///< file name
  PoseTable table;  ///< that was fitted
  RunFileContent file{};
  std::vector<InstrumentIdentity> instruments{};  ///< that answered, as the run file keeps it
  std::string operator_name{}, site{};            ///< empty: not stated
  fit::FitReport fit;
  criticism::tests::Comparison comparison;
  criticism::search::ExplainReport explained;
  std::vector<criticism::search::Choice> doubts{};  ///< what is open about effects of the kept model
  std::vector<LawPage> laws{};                      ///< that `mgt discover --keep` found
  std::string laws_note{};                          ///< of which poses, and when, where there are any
  std::string command{};                            ///< that makes this report again
  ReportFigures drawn{};
};

}  // namespace mgtd::calib::report
