// SPDX-License-Identifier: Apache-2.0
#include "tests/discovery/answer.h"

#include <fmt/format.h>

#include <cmath>
#include <regex>
#include <stdexcept>

#include "calib/discovery/channel_sums.h"
#include "calib/discovery/discover.h"
#include "calib/fit/joint/joint_report.h"
#include "calib/report/discovery_reason.h"
#include "tests/blind/unseen.h"

namespace mgtd::calib::testing {
namespace {

using discovery::FoundFormula;

constexpr int kUnseen = 100;

template <class T>
T must(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().text());
  return *std::move(result);
}

bool is_true(const UnknownLaw& law, const FoundFormula& f) {
  return f.where == "s3.z" && std::regex_match(f.formula, std::regex(law.truth));
}

/// Length in standard deviations of what the calibration cannot take of a law: the square root of what
/// chi-square falls by when the law is added.
double visible_length(const PoseTable& table, const Eigen::VectorXd& law_nT) {
  const auto options = must(fit::joint::profiled_options(table, fit::FitOptions{}));
  const fit::joint::JointFit fit = must(fit::joint::fit_joint(table, options));
  const criticism::tests::Residual residual(fit.problem, fit.state, 0);
  const discovery::ChannelSums sums(fit, residual);
  Eigen::VectorXd fitted(sums.poses());
  Eigen::Index row = 0;
  for (std::size_t k = 0; k < table.poses.size(); ++k)
    if (table.poses[k].set != "check") fitted[row++] = law_nT[static_cast<Eigen::Index>(k)];
  const int channel = 3 * static_cast<int>(kLawSensor) + kLawAxis;
  return std::sqrt(fitted.dot(sums.product(channel, channel, fitted).col(0)));
}

/// The effects of a formula; an effect of the library by its name and place.
std::vector<std::string> specs_of(const FoundFormula& formula) {
  if (!formula.specs.empty()) return formula.specs;
  if (formula.library.empty()) return {};
  return {formula.where == "all" ? formula.library : formula.library + "@" + formula.where};
}

/// With the law in its readings, and the same run without it.
struct Pair {
  PoseTable with, without;
};

Pair hidden_in_run(const UnknownLaw& law, Course course, double d, int unseen, std::uint64_t seed) {
  std::mt19937_64 rng(seed);
  RecordedRun run = recorded_run({.noise_nT = kNoise_nT, .unseen = unseen}, course, seed);
  const Eigen::VectorXd unit = values_of(law.draw(rng, run.weather), run.table);
  Pair out{.with = run.table, .without = std::move(run.table)};
  add(d / visible_length(out.without, unit) * unit, out.with);
  return out;
}

/// Of the squares that the law adds to the residual of unseen poses, the share that goes with `effects`.
double gain_of(const Pair& run, const std::vector<std::string>& effects) {
  const double bare = unseen_rms_nT(run.with, {}), after = unseen_rms_nT(run.with, effects),
               least = unseen_rms_nT(run.without, {});
  return (bare * bare - after * after) / (bare * bare - least * least);
}

}  // namespace

Answer ask(const PoseTable& table, const UnknownLaw* law, int draws) {
  const auto found = must(discovery::discover(table, {.fit = {}, .draws = draws, .checks = false}));
  const discovery::FoundLaw& first = found.laws.front();
  const FoundFormula& head = first.formulas.front();
  Answer out{.finding = found.finding, .log10_p = first.log10_p, .P = head.P};
  out.found = first.stands_out;
  out.formula = head.formula + " at " + head.where;
  out.set = first.formulas.size() + first.more;
  out.reason = report::reason_text(found), out.effects = specs_of(head);
  out.place = first.where.front().name == "s3.z";
  if (law == nullptr) return out;
  out.covariate = first.covariates.front().name == law->covariate;
  out.first = is_true(*law, head);
  for (const FoundFormula& f : first.formulas) {
    if (!is_true(*law, f)) continue;
    out.in_set = true;
    out.alike = out.alike || f.same_as == head.same_as;
  }
  return out;
}

Answer ask_of_law(const UnknownLaw& law, Course course, double d, std::uint64_t seed, int draws) {
  const Pair run = hidden_in_run(law, course, d, kUnseen, seed);
  Answer out = ask(run.with, &law, draws);
  if (out.found && !out.effects.empty()) out.gain = gain_of(run, out.effects);
  return out;
}

Answer ask_of_lawless(const UnknownLaw& law, double d, std::uint64_t seed, int draws) {
  return ask(hidden_in_run(law, Course::swing, d, 0, seed).with, nullptr, draws);
}

}  // namespace mgtd::calib::testing
