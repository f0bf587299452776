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
#include "calib/report/figures/figure.h"
#include "calib/report/law_pages.h"
#include "daemon/cli/fit_flags.h"
#include "daemon/run/run_judgement.h"
#include "daemon/store/model_history.h"
#include "daemon/store/pose_source.h"
#include "proto/instrument_identity.h"

/// ReportContent holds everything that the report of a run shows, as values and drawn figures.
namespace mgtd::daemon::cli {

struct ReportWishes {
  std::string run, output;
  std::string operator_name, site;   ///< that no run file holds
  std::vector<std::string> earlier;  ///< CAL.json or runs of the same rig, for the history of its parameters
};

struct ReportContent {
  std::string run;  ///< file name
  store::PoseSource source;
  std::vector<InstrumentIdentity> instruments;  ///< that answered, as the run file keeps it
  std::string operator_name, site;
  calib::fit::FitReport fit;
  calib::criticism::tests::Comparison comparison;
  calib::criticism::search::ExplainReport explained;
  std::optional<calib::criticism::search::Waterfall> waterfall;  ///< of a model with effects
  std::vector<run::RunJudgement> judgements;  ///< of a run that went on until it was explained
  std::vector<store::ModelStep> history;
  std::vector<calib::criticism::search::Choice> doubts;  ///< what is open about effects of the kept model
  std::vector<calib::report::LawPage> laws{};            ///< that `mgt discover --keep` found
  std::string laws_note{};                               ///< of which poses, and when, where there are any
  std::string command;                                   ///< that makes this report again

  // Figures, in the order of the page.
  std::vector<calib::report::figures::Figure> measured{}, panels{}, falls{}, candidates{}, limits{}, prices{},
      earlier{};
};

/// `on_round` hears of every round of its fits.
[[nodiscard]] Result<ReportContent> report_content(const ReportWishes& wishes, const FitFlags& flags,
                                                   calib::fit::RoundListener on_round = {});

/// The command line that says the same again: every option that was given, quoted for a shell where that is
/// needed.
[[nodiscard]] std::string report_command(const ReportWishes& wishes, const FitFlags& flags);

}  // namespace mgtd::daemon::cli
