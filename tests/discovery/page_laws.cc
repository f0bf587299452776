// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>
#include <map>
#include <regex>

#include "tests/blind/page.h"
#include "tests/discovery/answer.h"
#include "tests/discovery/pages.h"

namespace mgtd::calib::testing {
namespace {

using discovery::LawFinding;

constexpr std::array kSizes{10, 20, 40};

/// The middle one; zero of none.
template <class T>
T median(std::vector<T> values) {
  if (values.empty()) return {};
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::vector<double> gains_of(const std::vector<Answer>& all) {
  std::vector<double> out;
  for (const Answer& a : all)
    if (a.gain) out.push_back(*a.gain);
  return out;
}

/// "0.998 (0.91)": median and worst.
std::string gain_text(const std::vector<Answer>& all) {
  const std::vector<double> gains = gains_of(all);
  if (gains.empty()) return "-";
  return fmt::format("{:.3f} ({:.2f})", median(gains), *std::min_element(gains.begin(), gains.end()));
}

std::string rates(const std::vector<Answer>& all) {
  const auto n = static_cast<int>(all.size());
  const auto share = [&](auto is) { return percent(count_of(all, is), n); };
  return fmt::format("{} | {} | {} | {} | {} | {}", share([](const Answer& a) { return a.found; }),
                     share([](const Answer& a) { return a.place; }),
                     share([](const Answer& a) { return a.covariate; }),
                     share([](const Answer& a) { return a.first; }),
                     share([](const Answer& a) { return a.first || a.alike; }),
                     share([](const Answer& a) { return a.in_set; }));
}

bool is_wrong(const Answer& a) { return !a.first && !a.alike; }

using BySize = std::map<int, std::vector<Answer>>;

/// Rows of the laws; their answers are added to `all`.
std::string rows(const std::vector<UnknownLaw>& laws, Course course, std::uint64_t first_seed,
                 const Extent& extent, BySize& all) {
  const int runs = extent.runs;
  std::string out =
      "| law | d | found, % | place, % | covariate, % | first, % | or alike, % | in the 99 % set, % | size "
      "of the set, median | verdict LAW, % | gain on unseen poses, median (worst) "
      "|\n|---|---|---|---|---|---|---|---|---|---|---|\n";
  AnswerFile<Answer> file(extent.answers);
  for (std::size_t l = 0; l < laws.size(); ++l) {
    if (!std::regex_search(laws[l].name, std::regex(extent.law))) continue;
    for (const int d : kSizes) {
      const auto answers =
          cell(file,
               fmt::format("{}{}, d = {}, {} draws", course == Course::rise ? "rising: " : "", laws[l].name,
                           d, extent.draws),
               extent.first_seed + first_seed + 1000 * l + 17 * static_cast<std::uint64_t>(d), runs,
               [&](std::uint64_t seed) { return ask_of_law(laws[l], course, d, seed, extent.draws); });
      std::vector<std::size_t> sets;
      for (const Answer& a : answers) {
        sets.push_back(a.set);
        if (!a.first || a.finding != LawFinding::law)
          fmt::print(stderr, "{} d {}: {} P {:.2f} {}{}; {}\n", laws[l].name, d,
                     discovery::to_string(a.finding), a.P, a.formula, a.in_set ? "" : " (not in set)",
                     a.reason);
      }
      const int named = count_of(answers, [](const Answer& a) { return a.finding == LawFinding::law; });
      out += fmt::format("| {} | {} | {} | {} | {} | {} |\n", laws[l].name, d, rates(answers), median(sets),
                         percent(named, runs), gain_text(answers));
      all[d].insert(all[d].end(), answers.begin(), answers.end());
    }
  }
  return out + "\n";
}

std::string sums(const BySize& all) {
  std::string out =
      "| all fourteen, d | runs | found, % | place, % | covariate, % | first, % | or alike, % | in the 99 % "
      "set, % | LAW wrong, % | P above 0.99 and wrong, % | gain on unseen poses, "
      "median (worst) "
      "|\n|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const auto& [d, answers] : all) {
    const auto wrong_law = [](const Answer& a) { return a.finding == LawFinding::law && is_wrong(a); };
    const int sure = count_of(answers, [](const Answer& a) { return a.P > 0.99; });
    const int sure_wrong = count_of(answers, [](const Answer& a) { return a.P > 0.99 && is_wrong(a); });
    out += fmt::format("| {} | {} | {} | {} | {} | {} |\n", d, answers.size(), rates(answers),
                       percent(count_of(answers, wrong_law), static_cast<int>(answers.size())),
                       percent(sure_wrong, sure), gain_text(answers));
  }
  return out + "\n";
}

/// What P means: how often formulas that lead with so much are the true one. Where P is honest, no ranking of
/// these runs puts the true one first more often than the mean of P says.
std::string reliability(const BySize& all) {
  std::string out =
      "| P of the leading formula | runs | mean of P, % | it is the true one, % |\n|---|---|---|---|\n";
  const auto add_row = [&](const std::string& range, double above, double most) {
    int n = 0, right = 0;
    double mean = 0;
    for (const auto& [d, answers] : all)
      for (const Answer& a : answers)
        if (a.found && a.P > above && a.P <= most) ++n, right += a.first ? 1 : 0, mean += a.P;
    if (n == 0) return;
    out += fmt::format("| {} | {} | {:.1f} | {} |\n", range, n, 100 * mean / n, percent(right, n));
  };
  constexpr std::array kEdges{0.0, 0.3, 0.5, 0.7, 0.9, 0.99, 1.0};
  for (std::size_t i = 0; i + 1 < kEdges.size(); ++i)
    add_row(fmt::format("{} to {}", kEdges[i], kEdges[i + 1]), kEdges[i], kEdges[i + 1]);
  add_row("all", 0, 1);
  return out + "\n";
}

}  // namespace

std::string laws_page(const Extent& extent) {
  BySize all, further;
  std::string out =
      "## Laws of the grammar\n\nEach on s3.z, with numbers drawn anew in every run; d is the length, in "
      "standard deviations, of what the calibration leaves of the law (the square root of what chi-square "
      "falls by when the true law is added). *First*: the formula that leads is the one that was hidden. *Or "
      "alike*: or one that these poses do not tell from it. *LAW wrong*: the verdict was LAW and the formula "
      "neither. *Gain*: the leading formula is added; of the squares that the law adds to the residual of "
      "100 "
      "unseen poses without noise, among the others, the share that goes. 1 is all.\n\n";
  out += rows(unknown_laws(), Course::swing, 100'000, extent, all);
  out += sums(all);
  out += "What P is worth, over all of these runs in which something was found:\n\n" + reliability(all);
  out +=
      "Further laws, not counted above:\n\n" + rows(further_laws(), Course::swing, 200'000, extent, further);
  return out;
}

std::string rising_page(const Extent& extent) {
  BySize all;
  std::string out =
      "## The same laws, while the room warms up once\n\nBy six degrees, with a scatter of 0.4 degrees that "
      "is "
      "remembered for ten minutes; each head follows the room with a time constant of its own, 60 to 400 s. "
      "On "
      "the smooth curve above, where each head runs ahead of the one before it, a lag of one temperature "
      "looks "
      "like the temperature of another head, and a temperature times time like a temperature. Here dT/dt is "
      "the "
      "hard one: the grammar takes it from a line through nine poses, which such a room outruns.\n\n";
  out += rows(unknown_laws(), Course::rise, 300'000, extent, all);
  return out + sums(all) + reliability(all);
}

}  // namespace mgtd::calib::testing
