// SPDX-License-Identifier: Apache-2.0
#include "calib/design/next_measurement.h"

#include <algorithm>

#include "calib/criticism/tests/residual.h"
#include "calib/design/actions.h"
#include "calib/design/model_on_poses.h"
#include "calib/effects/library/effect_family.h"
#include "calib/effects/library/library.h"
#include "calib/linear/qr.h"

namespace mgtd::calib::design {
namespace {

constexpr double kWorthMeasuring = 0.01;  ///< gain of the probability that is worth telling
constexpr double kBetter = 0.005;         ///< than more of the same, for what takes more than that

/// Further poses of an action, beside the run they follow.
struct Further {
  PoseTable table;
  std::size_t here{0};  ///< poses at the place of the run: the first ones
};

Further further(const PoseTable& table, const Action& action, const fit::joint::JointFit& fit) {
  Further out{.table = extended(table, action, fit.state.sensors)};
  out.here = (action.moved ? table : out.table).poses.size();
  return out;
}

/// Rows of the poses at the place of the run; poses that no fit takes have none.
Eigen::Index rows_here(const fit::joint::JointProblem& problem, const Further& run) {
  const Pose* const end = run.table.poses.data() + run.here;
  return problem.pose_rows() *
         std::count_if(problem.poses.begin(), problem.poses.end(),
                       [end](const fit::joint::JointPose& pose) { return pose.pose < end; });
}

/// An effect of the site at two places: coefficients of the one, then of the other.
Eigen::MatrixXd at_two_places(const Eigen::MatrixXd& rows, Eigen::Index here) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(rows.rows(), 2 * rows.cols());
  out.topLeftCorner(here, rows.cols()) = rows.topRows(here);
  out.bottomRightCorner(rows.rows() - here, rows.cols()) = rows.bottomRows(rows.rows() - here);
  return out;
}

/// Projected columns of an effect; empty when these poses cannot feed it.
Eigen::MatrixXd columns_of(const ModelOnPoses& design, const criticism::tests::Residual& residual,
                           const std::string& spec, const Further& run, std::vector<std::string>* names) {
  const PoseTable& table = run.table;
  const auto parsed = effects::EffectSpec::parse(spec);
  if (!parsed) return {};
  const auto effect =
      effects::library::make_effect(*parsed, effects::EffectContext{.table = &table, .offset_nT = {}});
  if (!effect || !(*effect)->applicable(table)) return {};
  if (names != nullptr)
    for (const effects::Coefficient& c : (*effect)->coefficients()) names->push_back(c.name);
  const Eigen::MatrixXd rows = criticism::tests::effect_rows(design.problem, design.state, *effect);
  const Eigen::Index here = rows_here(design.problem, run);
  if ((*effect)->level() != effects::Level::site || here == rows.rows())
    return residual.project(rows).projected;
  return residual.project(at_two_places(rows, here)).projected;
}

Eigen::VectorXd sizes_of(const criticism::tests::Candidate& winner, const std::vector<std::string>& names) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(names.size()));
  for (std::size_t i = 0; i < names.size(); ++i) {
    for (const calibration::EffectCoefficient& c : winner.coefficients)
      if (c.name == names[i]) out[static_cast<Eigen::Index>(i)] = c.value;
  }
  return out;
}

/// What of `v` is not in the space of B, in squares.
double outside(const Eigen::VectorXd& v, const Eigen::MatrixXd& B) {
  return (v - B * linear::least_squares(B, v)).squaredNorm();
}

/// Two shapes of one dependence: both on the axis' own reading alone, or of one quantity (axis.offset, site)
/// on the same columns. An offset and a scale factor that drift differ by the reading, which is measured.
bool differ_in_form(const std::string& a, const std::string& b) {
  const auto reads = [](const std::string& spec) {
    const effects::library::EffectFamily* const family =
        effects::library::find_family(effects::family_name(spec));
    return family == nullptr ? std::string_view() : family->needs;
  };
  const auto quantity = [](const std::string& spec) {
    const std::string_view name = effects::family_name(spec);
    return name.substr(0, name.rfind('.'));
  };
  return reads(a) == reads(b) && (reads(a).empty() || quantity(a) == quantity(b));
}

/// Smallest probability, over the alternatives, that the winner's name comes out right if it is true.
double p_right(const Further& run, const ModelOnPoses& design, const criticism::tests::Residual& residual,
               const criticism::tests::Candidate& winner,
               const std::vector<criticism::tests::Alternative>& alternatives) {
  std::vector<std::string> names;
  const Eigen::MatrixXd Z = columns_of(design, residual, winner.spec, run, &names);
  if (Z.cols() == 0) return 0;
  const Eigen::VectorXd sizes = sizes_of(winner, names);
  const Eigen::VectorXd v =
      Z.leftCols(sizes.size()) * sizes;  // what the site made here is not at another place
  double lambda = v.squaredNorm();
  for (const criticism::tests::Alternative& alternative : alternatives) {
    const Eigen::MatrixXd B = columns_of(design, residual, alternative.spec, run, nullptr);
    if (B.cols() == 0) continue;
    const double distance = outside(v, B);
    lambda = std::min(
        lambda, alternative.form_only ? criticism::tests::beyond_form(distance, v.squaredNorm()) : distance);
  }
  return criticism::tests::probability_right(lambda);
}

double p_right_after(const Further& run, const fit::joint::JointFit& fit,
                     const fit::joint::JointOptions& options, const criticism::tests::Candidate& winner,
                     const std::vector<criticism::tests::Alternative>& alternatives) {
  const auto design = model_on_poses(run.table, fit, options);
  if (!design) return 0;
  const criticism::tests::Residual residual(design->problem, design->state, 0);
  return p_right(run, *design, residual, winner, alternatives);
}

std::vector<criticism::tests::Alternative> hardest(const criticism::tests::Candidate& winner) {
  std::vector<criticism::tests::Alternative> out;
  for (const criticism::tests::Alternative& alternative : winner.alternatives)
    if (alternative.possible) out.push_back(alternative);
  if (out.empty() && !winner.alternatives.empty()) {
    out.push_back(
        *std::min_element(winner.alternatives.begin(), winner.alternatives.end(),
                          [](const criticism::tests::Alternative& a, const criticism::tests::Alternative& b) {
                            return a.p_right < b.p_right;
                          }));
  }
  return out;
}

/// For alternatives that were not compared with the winner yet.
void find_form_only(const Further& run, const ModelOnPoses& design,
                    const criticism::tests::Residual& residual, const criticism::tests::Candidate& winner,
                    std::vector<criticism::tests::Alternative>& alternatives) {
  std::vector<std::string> names;
  const Eigen::MatrixXd Z = columns_of(design, residual, winner.spec, run, &names);
  if (Z.cols() == 0) return;
  const Eigen::VectorXd v = Z * sizes_of(winner, names);
  for (criticism::tests::Alternative& alternative : alternatives) {
    if (alternative.form_only || !differ_in_form(alternative.spec, winner.spec)) continue;
    const Eigen::MatrixXd B = columns_of(design, residual, alternative.spec, run, nullptr);
    alternative.form_only = B.cols() > 0 && outside(v, B) < (1 - criticism::tests::kAlike) * v.squaredNorm();
  }
}

}  // namespace

NextMenu next_measurements(const PoseTable& table, const fit::joint::JointFit& fit,
                           const fit::joint::JointOptions& options,
                           const criticism::tests::Candidate& winner) {
  NextMenu out;
  auto alternatives = hardest(winner);
  if (alternatives.empty()) return out;
  {
    const Further here{.table = table, .here = table.poses.size()};
    const auto design = model_on_poses(here.table, fit, options);
    if (!design) return out;
    const criticism::tests::Residual residual(design->problem, design->state, 0);
    find_form_only(here, *design, residual, winner, alternatives);
    out.p_right_before = p_right(here, *design, residual, winner, alternatives);
  }
  const PoseTable sound = with_predictions(table, fit);
  double worth = out.p_right_before + kWorthMeasuring;
  for (const Action& action : actions()) {
    const double after = p_right_after(further(sound, action, fit), fit, options, winner, alternatives);
    if (after < worth) continue;
    if (&action == actions().data()) worth = after + kBetter;
    out.steps.push_back(
        {.action = std::string(action.text),
         .minutes = action.extra_min + minutes_per_pose(table) * static_cast<double>(kActionPoses),
         .p_right_before = out.p_right_before,
         .p_right_after = after});
  }
  std::stable_sort(
      out.steps.begin(), out.steps.end(),
      [](const NextMeasurement& a, const NextMeasurement& b) { return a.p_right_after > b.p_right_after; });
  return out;
}

}  // namespace mgtd::calib::design
