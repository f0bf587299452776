// SPDX-License-Identifier: Apache-2.0
#include "calib/design/hypothesis_menu.h"

#include <algorithm>
#include <optional>

#include "calib/criticism/tests/alternatives.h"
#include "calib/design/candidate_poses.h"

namespace mgtd::calib::design {
namespace {

constexpr std::size_t kCandidates = 48;  ///< attitudes that are tried for each pose
constexpr double kGained = 1e-3;         ///< of lambda, or of a probability: less is nothing

struct Work {
  PoseTable run;  ///< with_predictions()
  const fit::joint::JointFit& fit;
  const fit::joint::JointOptions& options;
  std::uint64_t seed;
};

struct Tried {
  const LawAction* action;
  std::vector<Pose> poses;
  double minutes{0};
  std::vector<double> lambda;  ///< by pair
};

using Groups = std::vector<std::vector<CandidatePose>>;

/// The poses of an action and the run with them behind it, `which` of its candidates each pose is.
struct Longer {
  PoseTable table;
  double minutes{0};
};

Longer longer(const PoseTable& run, const Groups& groups, const std::vector<std::size_t>& which) {
  Longer out{.table = run};
  for (std::size_t k = 0; k < groups.size(); ++k) {
    out.table.poses.push_back(groups[k][which[k]].pose);
    out.minutes += groups[k][which[k]].minutes;
  }
  return out;
}

bool remembers_poses(const HypothesisFit& hypotheses) {
  return std::any_of(
      hypotheses.hypotheses.begin(), hypotheses.hypotheses.end(), [](const Hypothesis& hypothesis) {
        return std::any_of(hypothesis.specs.begin(), hypothesis.specs.end(),
                           [](const std::string& spec) { return spec.find("prev_") != std::string::npos; });
      });
}

/// Where a law knows the pose before: each pose behind the one that was chosen before it.
Result<std::vector<std::size_t>> chosen_in_order(const Groups& groups, const Work& work,
                                                 const HypothesisFit& hypotheses) {
  std::vector<std::size_t> which;
  std::optional<HypothesisDistance> distance;
  PoseTable measured = work.run;
  for (const auto& group : groups) {
    PoseTable table = measured;
    int number = 0;
    for (const Pose& pose : table.poses) number = std::max(number, pose.number);
    for (const CandidatePose& candidate : group) {
      for (const Pose& pose : {measured.poses.back(), candidate.pose}) {
        table.poses.push_back(pose);
        table.poses.back().t_s = candidate.pose.t_s;
        table.poses.back().number = ++number;
      }
    }
    const auto rows = hypothesis_rows(table, measured.poses.size(), hypotheses, work.fit, work.options);
    if (!rows) return tl::unexpected(rows.error());
    if (!distance) distance.emplace(rows->run, rows->fixed, rows->described, hypotheses.pairs);
    std::vector<PossiblePose> possible;
    for (std::size_t m = 0; m < group.size(); ++m)
      possible.push_back({.rows = rows->further[rows->further.size() - 2 * (group.size() - m) + 1],
                          .minutes = group[m].minutes});
    which.push_back(best_of(*distance, possible));
    distance->add(possible[which.back()].rows);
    measured.poses.push_back(group[which.back()].pose);
  }
  return which;
}

/// Which of its candidates each pose of an action is.
Result<std::vector<std::size_t>> chosen(const Groups& groups, const Work& work,
                                        const HypothesisFit& hypotheses) {
  if (groups.front().size() < 2) return std::vector<std::size_t>(groups.size(), 0);
  if (remembers_poses(hypotheses)) return chosen_in_order(groups, work, hypotheses);
  PoseTable table = work.run;
  int number = 0;
  for (const Pose& pose : work.run.poses) number = std::max(number, pose.number);
  for (const auto& group : groups) {
    for (const CandidatePose& candidate : group) {
      table.poses.push_back(candidate.pose);
      table.poses.back().number = ++number;
    }
  }
  const auto rows = hypothesis_rows(table, work.run.poses.size(), hypotheses, work.fit, work.options);
  if (!rows) return tl::unexpected(rows.error());
  std::vector<std::vector<PossiblePose>> possible;
  std::size_t next = 0;
  for (const auto& group : groups) {
    possible.emplace_back();
    for (const CandidatePose& candidate : group)
      possible.back().push_back({.rows = rows->further[next++], .minutes = candidate.minutes});
  }
  return placed(HypothesisDistance(rows->run, rows->fixed, rows->described, hypotheses.pairs), possible);
}

Result<Tried> tried(const LawAction& action, const Work& work, const HypothesisFit& hypotheses) {
  const Groups groups = candidate_poses(work.run, action, work.fit.state.sensors, kCandidates, work.seed);
  const auto which = chosen(groups, work, hypotheses);
  if (!which) return tl::unexpected(which.error());
  const Longer run = longer(work.run, groups, *which);
  auto lambda = distances_on(run.table, hypotheses, work.fit, work.options);
  if (!lambda) return tl::unexpected(lambda.error());
  return Tried{
      .action = &action,
      .poses = {run.table.poses.end() - static_cast<std::ptrdiff_t>(groups.size()), run.table.poses.end()},
      .minutes = action.extra_min + run.minutes,
      .lambda = *std::move(lambda)};
}

/// What an action adds to the probability of the right name a minute.
double a_minute(const HypothesisStep& step) {
  return (step.measurement.p_right_after - step.measurement.p_right_before) / step.measurement.minutes;
}

/// The pairs that something tells apart.
std::vector<std::size_t> pairs_told_apart(const std::vector<double>& before, const std::vector<Tried>& all) {
  std::vector<std::size_t> out;
  for (std::size_t p = 0; p < before.size(); ++p) {
    const bool helped = std::any_of(all.begin(), all.end(),
                                    [&](const Tried& t) { return t.lambda[p] > before[p] + kGained; });
    if (helped || before[p] >= criticism::tests::kToldApart) out.push_back(p);
  }
  return out;
}

/// The pairs that count, by their weights.
struct Open {
  const std::vector<HypothesisPair>& pairs;
  std::vector<std::size_t> count;
  const std::vector<double>& before;  ///< lambda on the run

  [[nodiscard]] std::size_t worst() const {
    return *std::max_element(count.begin(), count.end(), [this](std::size_t a, std::size_t b) {
      return still_open(pairs[a], before[a]) < still_open(pairs[b], before[b]);
    });
  }
  /// Of the right one of two, in the mean over the pairs.
  [[nodiscard]] double p_right(const std::vector<double>& lambda) const {
    double open = 0, weights = 0;
    for (const std::size_t p : count) {
      open += still_open(pairs[p], lambda[p] > before[p] + kGained ? lambda[p] : before[p]);
      weights += pairs[p].weight;
    }
    return 1 - open / weights;
  }
};

}  // namespace

Result<HypothesisMenu> hypothesis_menu(const PoseTable& run, const fit::joint::JointFit& fit,
                                       const fit::joint::JointOptions& options,
                                       const std::vector<Hypothesis>& hypotheses, std::uint64_t seed,
                                       std::span<const LawAction> actions) {
  if (hypotheses.size() < 2)
    return fail(ErrorCode::usage, "one formula alone leaves nothing to settle", "name two");
  const Work work{with_predictions(run, fit), fit, options, seed};
  auto fitted = hypothesis_fit(run, fit, options, hypotheses);
  if (!fitted) return tl::unexpected(fitted.error());
  HypothesisMenu out;
  out.hypotheses = *std::move(fitted);
  const auto before = distances_on(run, out.hypotheses, fit, options);
  if (!before) return tl::unexpected(before.error());
  std::vector<Tried> all;
  for (const LawAction& action : actions) {
    auto why = action.lacks == nullptr ? std::nullopt : action.lacks(run);
    if (why) {
      out.left_out.push_back({std::string(action.text), *std::move(why)});
      continue;
    }
    auto one = tried(action, work, out.hypotheses);
    if (!one) return tl::unexpected(one.error());
    all.push_back(*std::move(one));
  }
  std::vector<std::size_t> count = pairs_told_apart(*before, all);
  for (std::size_t p = 0; p < before->size(); ++p)
    if (std::find(count.begin(), count.end(), p) == count.end()) out.never.push_back(out.hypotheses.pairs[p]);
  if (count.empty())
    for (std::size_t p = 0; p < before->size(); ++p) count.push_back(p);
  const Open open{out.hypotheses.pairs, std::move(count), *before};
  const std::size_t worst = open.worst();
  out.worst = out.hypotheses.pairs[worst];
  out.lambda_before = (*before)[worst];
  out.p_right_before = open.p_right(*before);
  for (Tried& one : all) {
    const double after = open.p_right(one.lambda);
    if (after < out.p_right_before + kGained) continue;
    out.steps.push_back({.measurement = {.action = std::string(one.action->text),
                                         .minutes = one.minutes,
                                         .p_right_before = out.p_right_before,
                                         .p_right_after = after,
                                         .lambda_before = out.lambda_before,
                                         .lambda_after = one.lambda[worst]},
                         .poses = std::move(one.poses),
                         .by_the_rig = one.action->by_the_rig && has_table(run),
                         .other_day = one.action->other_day});
  }
  std::stable_sort(out.steps.begin(), out.steps.end(), [](const HypothesisStep& a, const HypothesisStep& b) {
    return a_minute(a) > a_minute(b);
  });
  return out;
}

}  // namespace mgtd::calib::design
