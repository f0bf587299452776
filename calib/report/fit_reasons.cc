// SPDX-License-Identifier: Apache-2.0
#include "calib/report/fit_reasons.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "calib/calibration/scale_gauge.h"
#include "calib/fit/checks/check_limits.h"
#include "calib/fit/checks/identifiability_text.h"
#include "calib/fit/checks/mirrored_text.h"
#include "calib/fit/joint/joint_findings.h"
#include "calib/fit/joint/table_ceiling.h"
#include "calib/report/outlier_text.h"
#include "calib/report/reference_text.h"
#include "calib/report/wandering_text.h"
#include "proto/units.h"

namespace mgtd::calib::report {
namespace {

std::vector<std::string> remarks_on_any(const fit::FitReport& report) {
  std::vector<std::string> out;
  const PerSensor<sensor::SensorModel>& sensors = report.calibration.sensors;
  const auto is_mirrored = [](const sensor::SensorModel& s) { return s.mounting.determinant() < 0; };
  const auto count = static_cast<std::size_t>(std::count_if(sensors.begin(), sensors.end(), is_mirrored));
  const std::string_view mirrored = fit::checks::handedness_is_open(count, sensors.size())
                                        ? "mirrored against the other half of the array"
                                        : "mirrored (an axis wired backwards, or two swapped)";
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const sensor::SensorModel& s = sensors[i];
    if (s.mounting.isIdentity()) continue;
    std::string axes;
    for (int p = 0; p < 3; ++p) {
      int a = 0;
      s.mounting.row(p).cwiseAbs().maxCoeff(&a);
      axes += fmt::format("{}{} is platform {}", axes.empty() ? "" : ", ",
                          s.mounting(p, a) < 0 ? std::string("-") + "xyz"[a] : std::string(1, "xyz"[a]),
                          "XYZ"[p]);
    }
    out.push_back(
        fmt::format("sensor s{} is {}: its {}", i + 1, is_mirrored(s) ? mirrored : "mounted turned", axes));
  }
  if (std::string left = lack_of_fit_text(report); !left.empty()) out.push_back(std::move(left));
  constexpr std::size_t kMostLines = 40;  // a recording can have hundreds
  const std::vector<std::string> left_out = outlier_texts(report.outliers);
  for (std::size_t i = 0; i < std::min(kMostLines, left_out.size()); ++i)
    out.push_back(left_out[i] + "; left out of the fit");
  if (left_out.size() > kMostLines)
    out.push_back(fmt::format("{} more like these; mgt fit --json lists them all under outliers",
                              left_out.size() - kMostLines));
  return out;
}

/// What only a joint fit recognises.
std::vector<std::string> remarks_on_joint(const fit::FitReport& report) {
  const fit::joint::JointFindings& found = *report.joint;
  std::vector<std::string> out;
  if (found.birge_ratio > 1) {
    out.push_back(fmt::format(
        "for the uncertainties the readings count as {:.4g} times as noisy (the root of chi-square "
        "per degree of freedom), so that they cover what the model leaves out",
        found.birge_ratio));
  }
  if (found.samples_per_effective > 1) {
    out.push_back(fmt::format(
        "neighbouring samples of this recording are alike: {:.3g} of them count as one in the uncertainties",
        found.samples_per_effective));
  }
  if (calibration::scale_is_free(report.calibration)) {
    out.push_back(
        fmt::format("no field is known, so {}: fields and gradients are in units of the mean scale "
                    "factor; give the field of the site with --field, or measure it",
                    calibration::kScaleIsFree));
  }
  for (const std::string& weak : weak_texts(report)) out.push_back("weakly known: " + weak);
  if (!found.known.add.empty()) {
    out.push_back(fmt::format("{}; what would help most: {}", fit::checks::to_text(found.known.coverage),
                              fit::checks::additions_text(found.known.add, report.table.sd_rad > 0)));
  }
  if (fit::checks::table_is_rough(report.table.sd_rad, report.table.stated_sd_rad))
    out.push_back(rough_table_text(report.table.sd_rad, report.table.stated_sd_rad));
  if (found.wandering.any()) {
    out.push_back(wandering_text(found.wandering) +
                  ", or a law that the model lacks (mgt explain asks which): the uncertainties contain it, "
                  "offsets as at the end of the run");
  }
  if (found.quantisation.seen()) {
    out.push_back(fmt::format("readings stand in steps of {:.3g} nT: the uncertainties contain it",
                              found.quantisation.step_nT));
  }
  if (found.dwell_motion)
    if (std::string moves = dwell_motion_text(
            *found.dwell_motion, calibration::root_mean_square(report.calibration.sample_noise_nT));
        !moves.empty())
      out.push_back(std::move(moves));
  if (found.reference_scatter)
    if (std::string off = reference_scatter_remark(*found.reference_scatter); !off.empty())
      out.push_back(std::move(off));
  return out;
}

void append(std::vector<std::string> texts, std::vector<std::string>& out) {
  out.insert(out.end(), std::make_move_iterator(texts.begin()), std::make_move_iterator(texts.end()));
}

}  // namespace

std::vector<std::string> fit_reasons(const fit::FitReport& report) {
  std::vector<std::string> out = report.found_beside;
  for (const Check& check : report.calibration.checks) {
    if (check.passed) continue;
    out.push_back(fmt::format("{}: {}; limit {}; {}", check.name, check.measured, check.limit, check.remedy));
  }
  append(remarks_on_any(report), out);
  if (report.joint) append(remarks_on_joint(report), out);
  return out;
}

std::string lack_of_fit_text(const fit::FitReport& report) {
  if (!(report.dof > 0)) return {};
  const double ratio = std::sqrt(report.chi2 / report.dof);
  // The square root of chi-square per degree of freedom scatters by 1/sqrt(2 dof).
  if (ratio <= 1 + 5 / std::sqrt(2 * report.dof)) return {};
  const std::string size =
      report.residual_nT > 0
          ? fmt::format("the residual is {:.3g} nT", report.residual_nT)
          : fmt::format("|b| less F scatters as if that noise were {:.3g} nT", ratio * report.noise_nT);
  return fmt::format("the model leaves something out: {}, and the noise of a pose mean is {:.3g} nT", size,
                     report.noise_nT);
}

std::vector<std::string> weak_texts(const fit::FitReport& report) {
  std::vector<std::string> out;
  if (!report.joint) return out;
  for (const fit::joint::WeakDirection& weak : report.joint->known.weak)
    out.push_back(fmt::format("{} ({})", fit::checks::to_text(weak), fit::checks::weak_sd_text(weak.sd_nT)));
  return out;
}

std::string rough_table_text(double estimated_rad, double stated_rad) {
  if (!fit::joint::or_more(estimated_rad).empty())
    return fmt::format(
        "the table angles are off by {:.2g} deg a pose or more, where {:.2g} deg was told, and count for "
        "nothing: check the sense, the order and the zero of every table axis",
        to_deg(estimated_rad), to_deg(stated_rad));
  return fmt::format(
      "the table angles are good to {0:.2g} deg a pose, estimated, where {1:.2g} deg was told: --table-sd "
      "{0:.2g} tells it; of a table with a motor, check the zero and the sense of each axis",
      to_deg(estimated_rad), to_deg(stated_rad));
}

}  // namespace mgtd::calib::report
