// SPDX-License-Identifier: Apache-2.0
#include "calib/report/explain_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <utility>

#include "calib/criticism/tests/candidate.h"
#include "calib/report/outlier_text.h"
#include "calib/report/size_text.h"
#include "calib/report/verdict_text.h"
#include "calib/stats/probability.h"

namespace mgtd::calib::report {
namespace {

constexpr std::size_t kCandidatesShown = 12, kMapsShown = 6;
constexpr double kBarStep = 2;  ///< d of one character

std::string marks(double d) {
  return std::string(static_cast<std::size_t>(std::min(d / kBarStep, 20.0)), '#');
}

std::string share_text(const criticism::tests::Candidate& c) {
  return std::isfinite(c.share) ? fmt::format("{:.2f}", c.share) : "-";
}

void whole_table(std::span<const criticism::tests::Candidate> all, std::string& out) {
  const auto to = std::back_inserter(out);
  fmt::format_to(to, "\n{:<32} {:<11} {:>2} {:>7} {:>9} {:>6}  {:<32}\n", "effect", "where", "k", "d", "p",
                 "share", "size");
  for (const criticism::tests::Candidate& c : all)
    fmt::format_to(to, "{:<32} {:<11} {:>2} {:>7.1f} {:>9} {:>6}  {:<32} {}\n", c.effect, c.where, c.k, c.d,
                   stats::p_text(c.log10_p), share_text(c), size_text(c), marks(c.d));
  out += "k: coefficients; d: size in its own standard deviations; p: that chance alone makes it;\n";
}

void short_table(std::span<const criticism::tests::Candidate> all, std::string& out) {
  const auto to = std::back_inserter(out);
  fmt::format_to(to, "\n{:<32} {:>7} {:>8} {:>5}  {}\n", "effect and where", "d", "p", "share", "size");
  for (const criticism::tests::Candidate& c : all)
    fmt::format_to(to, "{:<32} {:>7.1f} {:>8} {:>5}  {}\n", fmt::format("{} {}", c.effect, c.where), c.d,
                   stats::p_text(c.log10_p), share_text(c), size_text(c));
  out += "d: size in its own standard deviations; p: that chance alone makes it;\n";
}

void candidates(const criticism::search::ExplainReport& r, std::size_t width, std::string& out) {
  constexpr std::size_t kWholeTable = 108;
  if (r.candidates.empty()) return;
  const auto all = std::span(r.candidates).first(std::min(kCandidatesShown, r.candidates.size()));
  if (width < kWholeTable)
    short_table(all, out);
  else
    whole_table(all, out);
  fmt::format_to(std::back_inserter(out), "share: of {}; size: of the coefficient that is best seen\n",
                 share_of(r));
}

void maps(const std::vector<criticism::tests::MapScore>& all, std::string& out) {
  const auto to = std::back_inserter(out);
  if (all.empty()) return;
  fmt::format_to(to, "\n{:<32} {:<11} {:>3} {:>9}\n", "residual against", "where", "k", "p");
  for (std::size_t i = 0; i < std::min(kMapsShown, all.size()); ++i) {
    const criticism::tests::MapScore& m = all[i];
    fmt::format_to(to, "{:<32} {:<11} {:>3} {:>9}\n", m.map, m.where, m.k, stats::p_text(m.log10_p));
  }
}

void impacts(const std::vector<criticism::tests::Candidate>& all, std::string& out) {
  const auto to = std::back_inserter(out);
  bool first = true;
  for (const criticism::tests::Candidate& c : all) {
    if (!c.impact || c.impact->component.empty()) continue;
    if (std::exchange(first, false))
      out += "\nwhat ignoring it does to the tensor, if it is there as it was fitted (worst component):\n";
    fmt::format_to(to, "  {:<32} {:>9.3g} nT/m in {}\n", c.effect, c.impact->nT_per_m, c.impact->component);
  }
}

/// The pairs that look alike; most of the matrix does not.
void confusions(const criticism::tests::ConfusionMatrix& c, std::string& out) {
  constexpr double kAlike = 0.9;
  const auto to = std::back_inserter(out);
  out += "\nwhat looks alike on this run (correlation, and that the right one is named at d = 8):\n";
  std::size_t pairs = 0;
  for (Eigen::Index a = 0; a < c.correlation.rows(); ++a) {
    for (Eigen::Index b = 0; b < c.correlation.cols(); ++b) {
      if (a == b || c.correlation(a, b) < kAlike) continue;
      fmt::format_to(to, "  {:<32} looks like {:<32} {:.3f} {:.2f}\n", c.effects[static_cast<std::size_t>(a)],
                     c.effects[static_cast<std::size_t>(b)], c.correlation(a, b), c.p_right(a, b));
      ++pairs;
    }
  }
  if (pairs == 0) out += "  no two of them above 0.9\n";
}

}  // namespace

std::string to_text(const criticism::search::ExplainReport& r, std::size_t width) {
  std::string out;
  const auto to = std::back_inserter(out);
  fmt::format_to(to, "{}{}{}\n{}\n", to_string(r.finding), r.named.empty() ? "" : ": ", names_text(r),
                 sentence(r));
  candidates(r, width, out);
  impacts(r.candidates, out);
  maps(r.maps, out);
  if (r.confusion) confusions(*r.confusion, out);
  if (!r.detectable.empty())
    fmt::format_to(to, "\nsmallest size that would have been seen{} (d = 8):\n",
                   r.rounds.empty() ? "" : ", with what was added in the model");
  for (const criticism::tests::Detectable& d : r.detectable)
    fmt::format_to(to, "  {:<32} {}\n", d.effect, detectable_text(d));
  if (!r.untestable.empty()) out += "\nthese poses cannot test:\n";
  for (const criticism::tests::Untestable& u : r.untestable)
    fmt::format_to(to, "  {:<32} {}\n", u.effect, u.why);
  if (!r.next.empty())
    out += "\nwhat would settle the name (probability that the right one wins, before -> after):\n";
  for (const design::NextMeasurement& n : r.next) {
    fmt::format_to(to, "  {:.3f} -> {:.3f}  {:>3.0f} min  {}\n", n.p_right_before, n.p_right_after, n.minutes,
                   n.action);
  }
  for (const std::string& text : outlier_texts(r.outliers)) fmt::format_to(to, "left out: {}\n", text);
  return out;
}

}  // namespace mgtd::calib::report
