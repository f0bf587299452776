// SPDX-License-Identifier: Apache-2.0
#include "daemon/acquire/calibrated_with.h"

#include <fmt/format.h>

#include "calib/criticism/tests/exchange_in_run.h"
#include "calib/report/rearrangement_text.h"
#include "daemon/acquire/instrument_watch.h"

namespace mgtd::daemon::acquire {
namespace {

constexpr std::string_view kPrefix = "instrument.";

}  // namespace

std::vector<Check> to_checks(const std::vector<InstrumentIdentity>& instruments) {
  std::vector<Check> out;
  for (const InstrumentIdentity& i : instruments)
    out.push_back(
        {std::string(kPrefix) + i.place, true, i.identity, "the calibration holds for this one", ""});
  return out;
}

std::vector<InstrumentIdentity> instruments_among(const std::vector<Check>& checks) {
  std::vector<InstrumentIdentity> out;
  for (const Check& c : checks)
    if (c.name.starts_with(kPrefix)) out.push_back({c.name.substr(kPrefix.size()), c.measured});
  return out;
}

void name_instruments(calib::calibration::Calibration& calibration, const std::filesystem::path& run) {
  if (run.extension() != ".mgtrun") return;
  const auto file = store::RunFile::open(run, store::Access::read_only);
  if (!file) return;
  const auto known = file->checks(kInstrumentsStage);
  if (!known || known->empty()) return;
  calibration.checks.insert(calibration.checks.end(), known->begin(), known->end());
  calibration.seal();
}

void hold_against(const calib::calibration::Calibration& active, calib::fit::FitReport& report) {
  InstrumentWatch watch;
  watch.want(instruments_among(active.checks));
  for (const InstrumentIdentity& i : instruments_among(report.calibration.checks)) watch.answers(i);
  if (watch.another()) return;
  const auto exchanged = calib::criticism::tests::exchanged_since(active, report.calibration);
  if (!exchanged) return;
  const Check check{"exchange", false,
                    fmt::format("{}: each has the scales, angles and offsets that calibration {} has for the "
                                "other",
                                calib::report::rearrangement_text(*exchanged), active.id),
                    "each sensor where it was calibrated",
                    "swap the plugs back and measure again; when they are meant to stay so, accept it with "
                    "--force"};
  report.found_beside.insert(report.found_beside.begin(),
                             fmt::format("{}: {}; {}", check.name, check.measured, check.remedy));
  report.calibration.checks.push_back(check);
  report.calibration.accepted_by_checks = false;
  report.calibration.seal();
}

}  // namespace mgtd::daemon::acquire
