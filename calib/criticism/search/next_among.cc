// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/search/next_among.h"

#include "calib/criticism/tests/alternatives.h"
#include "calib/design/hypothesis_menu.h"
#include "calib/fit/joint/joint_report.h"

namespace mgtd::calib::criticism::search {
namespace {

std::string name_of(const design::Hypothesis& hypothesis) {
  return hypothesis.specs.size() == 1 ? hypothesis.specs.front() : hypothesis.name;
}

}  // namespace

Result<NextReport> next_among(const PoseTable& table, const fit::FitOptions& options,
                              const std::vector<design::Hypothesis>& hypotheses) {
  const auto joint = fit::joint::profiled_options(table, options);
  if (!joint) return tl::unexpected(joint.error());
  const auto fit = fit::joint::fit_joint_at_size(table, *joint);
  if (!fit) return tl::unexpected(fit.error());
  auto menu = design::hypothesis_menu(table, *fit, *joint, hypotheses, options.seed);
  if (!menu) return tl::unexpected(menu.error());
  NextReport out;
  const std::vector<design::Hypothesis>& all = menu->hypotheses.hypotheses;
  out.effect = name_of(all[menu->worst.truth]);
  out.alternative = name_of(all[menu->worst.other]);
  out.d = menu->hypotheses.d[menu->worst.truth], out.assumed = menu->hypotheses.assumed;
  out.p_right_before = menu->p_right_before, out.lambda_before = menu->lambda_before;
  for (const design::HypothesisPair& pair : menu->never)
    out.never.emplace_back(name_of(all[pair.truth]), name_of(all[pair.other]));
  out.hypotheses = std::move(menu->hypotheses.hypotheses);
  out.left_out = std::move(menu->left_out);
  out.told_apart = menu->p_right_before >= tests::probability_right(tests::kToldApart);
  if (out.told_apart) return out;
  for (design::HypothesisStep& step : menu->steps)
    out.steps.push_back({.measurement = std::move(step.measurement),
                         .by_the_rig = step.by_the_rig,
                         .of_another_run = step.other_day,
                         .poses = std::move(step.poses)});
  out.none_helps = out.steps.empty();
  return out;
}

}  // namespace mgtd::calib::criticism::search
