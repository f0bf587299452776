// SPDX-License-Identifier: Apache-2.0
#include "tests/blind/blind.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>
#include <stdexcept>

#include "calib/criticism/search/improve.h"
#include "calib/criticism/tests/residual.h"

namespace mgtd::calib::testing {
namespace {

double told_at_best(const criticism::search::ExplainReport& r) {
  double out = 1;
  if (r.rounds.empty()) return out;
  for (const criticism::tests::Alternative& alternative : r.rounds.front().added.alternatives)
    out = std::min(out, alternative.p_right);
  return out;
}

void count(const criticism::search::ExplainReport& r, const std::string& truth, Answers& out) {
  ++out.runs;
  ++out.findings[r.finding];
  if (r.finding == criticism::search::Finding::pass) return;
  ++out.detected;
  out.told_at_best += told_at_best(r);
  if (r.named.empty()) return;
  ++out.first[r.named.front()];
  std::vector<std::string> set = r.named;
  for (const criticism::search::Round& round : r.rounds)
    set.insert(set.end(), round.possible.begin(), round.possible.end());
  std::sort(set.begin(), set.end());
  set.erase(std::unique(set.begin(), set.end()), set.end());
  out.set_sizes.push_back(static_cast<int>(set.size()));
  if (r.named.front() == truth) ++out.named_first;
  if (std::find(set.begin(), set.end(), truth) != set.end()) ++out.in_set;
  if (r.finding == criticism::search::Finding::explained && r.named.front() != truth) ++out.wrong_single;
}

bool changes_the_field(const criticism::search::ExplainReport& r) {
  return !r.next.empty() && r.next.front().action.find("field") != std::string::npos;
}

/// Every effect of the library but one.
std::vector<criticism::tests::CandidateEffect> library_without(const PoseTable& table,
                                                               std::string_view name) {
  std::vector<criticism::tests::CandidateEffect> out = criticism::tests::library_candidates(table).testable;
  std::erase_if(out, [&](const criticism::tests::CandidateEffect& s) { return s.name == name; });
  return out;
}

struct Pick {
  const HiddenLaw* law;
  int sensor, axis;
};

Hidden both(const Hidden& a, const Hidden& b) {
  return [a, b](const Pose& p, int s, int axis, const Eigen::Vector3d& v) {
    return a(p, s, axis, v) + b(p, s, axis, v);
  };
}

void count(const criticism::search::ImproveReport& r, const std::array<Pick, 2>& truth, TwoAnswers& out) {
  const auto is_true = [&](const std::string& name) {
    return name == truth[0].law->name || name == truth[1].law->name;
  };
  int added = 0, found = 0;
  for (const Pick& pick : truth) {
    const std::string name(pick.law->name);
    const auto has = [&](const criticism::search::ImproveRound& round) { return round.added.effect == name; };
    const auto may = [&](const criticism::search::ImproveRound& round) {
      return has(round) ||
             std::find(round.possible.begin(), round.possible.end(), name) != round.possible.end();
    };
    const bool was_found = std::any_of(r.rounds.begin(), r.rounds.end(), may);
    added += std::any_of(r.rounds.begin(), r.rounds.end(), has) ? 1 : 0;
    found += was_found ? 1 : 0;
    if (!was_found) ++out.missed[name];
  }
  const bool wrong =
      std::any_of(r.rounds.begin(), r.rounds.end(), [&](const criticism::search::ImproveRound& round) {
        return !is_true(round.added.effect) &&
               std::none_of(round.possible.begin(), round.possible.end(), is_true);
      });
  out.both_added += added == 2 ? 1 : 0;
  out.both_found += found == 2 ? 1 : 0;
  out.wrong_added += wrong ? 1 : 0;
}

}  // namespace

void ask(const PoseTable& table, const std::string& truth, const criticism::search::ExplainOptions& options,
         Answers& out) {
  const auto report = criticism::search::explain(table, options);
  if (!report) {
    ++out.runs, ++out.refused;
    return;
  }
  count(*report, truth, out);
  if (changes_the_field(*report)) ++out.advised;
  if (report->finding == criticism::search::Finding::pass && report->noise.wandering.any()) ++out.wanders;
}

int Answers::of(criticism::search::Finding finding) const {
  const auto found = findings.find(finding);
  return found == findings.end() ? 0 : found->second;
}

Answers& Answers::operator+=(const Answers& other) {
  runs += other.runs, refused += other.refused, detected += other.detected;
  named_first += other.named_first, in_set += other.in_set, wrong_single += other.wrong_single;
  advised += other.advised, wanders += other.wanders, told_at_best += other.told_at_best;
  set_sizes.insert(set_sizes.end(), other.set_sizes.begin(), other.set_sizes.end());
  for (const auto& [finding, count] : other.findings) findings[finding] += count;
  for (const auto& [name, count] : other.first) first[name] += count;
  return *this;
}

Answers clean(const HiddenRun& run, int runs, std::uint64_t seed) {
  Answers out;
  for (int i = 0; i < runs; ++i) ask(hidden_run(run, seed + static_cast<std::uint64_t>(i)), "", {}, out);
  return out;
}

double crb_of(const HiddenLaw& law, int sensor, int axis, std::uint64_t seed) {
  const PoseTable table = hidden_run({}, seed);
  const auto fit = fit::joint::fit_joint(table, {});
  if (!fit) throw std::runtime_error(fit.error().text());
  const criticism::tests::Residual residual(fit->problem, fit->state, 0);
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(residual.poses() * fit->problem.pose_rows(), 1);
  for (Eigen::Index k = 0; k < residual.poses(); ++k) {
    const fit::joint::JointPose& pose = fit->problem.poses[static_cast<std::size_t>(k)];
    const Eigen::Vector3d v =
        pose.y_nT.segment<3>(3 * sensor) - fit->state.sensors[static_cast<std::size_t>(sensor)].offset_nT;
    const int c = 3 * sensor + axis;
    rows(k * fit->problem.pose_rows() + c, 0) = pose.weight[c] * law.law(*pose.pose, sensor, axis, v);
  }
  return 1 / residual.project(rows).projected.norm();
}

Answers hidden(const HiddenLaw& law, double d, int runs, std::uint64_t seed, bool taken_out) {
  Answers out;
  for (int i = 0; i < runs; ++i) {
    const std::uint64_t s = seed + static_cast<std::uint64_t>(i);
    const int c = i % sensor::kChannels;
    const double size = (i % 2 == 0 ? d : -d) * crb_of(law, c / 3, c % 3, s);
    const PoseTable table = hidden_run({.hidden = hide(law, c / 3, c % 3, size)}, s);
    criticism::search::ExplainOptions options;
    if (taken_out) options.candidate_effects = library_without(table, law.name);
    ask(table, std::string(law.name), options, out);
  }
  return out;
}

TwoAnswers two_hidden(double d, int runs, std::uint64_t seed) {
  TwoAnswers out;
  const auto laws = hidden_laws();
  for (int i = 0; i < runs; ++i) {
    const std::uint64_t s = seed + static_cast<std::uint64_t>(i);
    std::mt19937_64 random(s);
    const std::size_t a = random() % laws.size(), b = (a + 1 + random() % (laws.size() - 1)) % laws.size();
    const int c = static_cast<int>(random() % 12), e = (c + 1 + static_cast<int>(random() % 11)) % 12;
    const std::array<Pick, 2> truth{{{&laws[a], c / 3, c % 3}, {&laws[b], e / 3, e % 3}}};
    std::array<Hidden, 2> parts;
    for (std::size_t k = 0; k < 2; ++k) {
      const Pick& p = truth.at(k);
      parts.at(k) = hide(*p.law, p.sensor, p.axis, d * crb_of(*p.law, p.sensor, p.axis, s));
    }
    const auto report = criticism::search::improve(hidden_run({.hidden = both(parts[0], parts[1])}, s), {});
    ++out.runs;
    if (report) count(*report, truth, out);
  }
  return out;
}

Proportion proportion(int hits, int of) {
  if (of == 0) return {};
  constexpr double z = 1.96;
  const double n = of, p = hits / n, scale = 1 / (1 + z * z / n);
  const double middle = scale * (p + z * z / (2 * n));
  const double half = scale * z * std::sqrt(p * (1 - p) / n + z * z / (4 * n * n));
  return {100 * p, 100 * std::max(0.0, middle - half), 100 * std::min(1.0, middle + half)};
}

}  // namespace mgtd::calib::testing
