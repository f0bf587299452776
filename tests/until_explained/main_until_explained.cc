// SPDX-License-Identifier: Apache-2.0
// Writes docs/until-explained-benchmark.md: something is hidden in simulated rigs, each is measured until it
// is explained, by the real drivers in virtual time, and what the first and the last look say is counted.
#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <nlohmann/json.hpp>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <fstream>
#include <random>

#include "calib/linear/parts.h"
#include "daemon/store/run_file.h"
#include "tests/blind/page.h"
#include "tests/blind/planted.h"
#include "tests/rig/effect_list.h"
#include "tests/rig/seal.h"
#include "tests/rig/simulated_table.h"
#include "tests/scenario/judged_run.h"

namespace mgtd::test {
namespace {

constexpr double kMinutes = 40;      ///< beside the plan
constexpr double kLeastSigmas = 10;  ///< of what is hidden

enum class Said { right, in_set, open, wrong };

struct Game {
  std::uint64_t seed{0};
  std::string hidden;
  bool in_library{true};
  std::vector<daemon::run::RunJudgement> judgements;
  std::size_t deeds{0};
  std::string stuck;  ///< why it did not end
};

/// What a look says of a law of the library: its name alone, its name among others, no name, or another one.
/// A law of no library is right where no effect is named for it, whatever formula is; names for a part of it
/// (PARTIAL) count as such.
Said said(const Game& game, const std::string& found) {
  const bool explained = found.starts_with("EXPLAINED"), named = found.find(game.hidden) != std::string::npos;
  if (!game.in_library)
    return explained ? Said::wrong : found.starts_with("PARTIAL") ? Said::in_set : Said::right;
  if (explained) return found == "EXPLAINED: " + game.hidden ? Said::right : Said::wrong;
  return named ? Said::in_set : Said::open;
}

/// A run file of every look, as mgt takes it.
void keep(const std::vector<PoseTable>& looked_at, std::uint64_t seed, const std::string& folder) {
  for (std::size_t look = 0; look < looked_at.size(); ++look) {
    const auto kept = daemon::store::import_poses(looked_at[look],
                                                  fmt::format("{}/{}-{}.mgtrun", folder, seed, look + 1), {});
    if (!kept) fmt::print(stderr, "{}\n", kept.error().text());
  }
}

rig::Scenario hiding_one(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  return rig::with_hidden(scenario_of(fmt::format("[rig]\nparameters = \"random\"\nseed = {}\n", seed)), 1,
                          random);
}

/// How much of the effect a run of 157 poses can show, in standard deviations.
double sigmas_hidden(const rig::Scenario& scenario, std::uint64_t seed) {
  rig::Scenario bare = scenario;
  bare.effects.pop_back();
  const rig::Design design = rig::run_of_157({.senses = true}, seed);
  return calib::testing::sigmas_between(rig::simulated_table(bare, design, seed),
                                        rig::simulated_table(scenario, design, seed), {});
}

/// The first so many, from `first` on, whose effect can be seen.
std::vector<std::uint64_t> seeds_that_show(std::uint64_t first, int count) {
  std::vector<std::uint64_t> out;
  for (std::uint64_t seed = first; static_cast<int>(out.size()) < count; ++seed) {
    const rig::Scenario scenario = hiding_one(seed);
    const double sigmas = sigmas_hidden(scenario, seed);
    if (sigmas >= kLeastSigmas)
      out.push_back(seed);
    else
      fmt::print(stderr, "{} {}: {:.1f} sigma, not played\n", seed,
                 scenario.effects.back()->truth().at("effect").get<std::string>(), sigmas);
  }
  return out;
}

Game play(std::uint64_t seed, const std::string& folder) {
  const rig::Scenario scenario = hiding_one(seed);
  Game out{.seed = seed, .hidden = {}, .judgements = {}, .stuck = {}};
  out.hidden = scenario.effects.back()->truth().at("effect");
  if (out.hidden == "site.gradient-step") out.hidden = "site.step";  // its name in the library
  out.in_library = !out.hidden.starts_with("hidden.");
  JudgedRun run(scenario, kMinutes);
  if (!run.run() && run.daemon.status) out.stuck = run.daemon.status->message;
  out.judgements = run.judgements, out.deeds = run.deeds.size();
  if (!folder.empty()) keep(run.looked_at, seed, folder);
  return out;
}

std::vector<Game> play_all(const std::vector<std::uint64_t>& seeds, const std::string& folder) {
  std::vector<Game> out(seeds.size());
  calib::linear::for_each_part(seeds.size(), [&](std::size_t i) {
    Game& game = out[i];
    game = play(seeds[i], folder);
    for (const daemon::run::RunJudgement& j : game.judgements)
      fmt::print(stderr, "{} {} ({} poses): {}; {}\n", seeds[i], game.hidden, j.poses, j.found, j.next);
  });
  return out;
}

std::string counts(const std::vector<Game>& games, bool in_library) {
  std::string out =
      "| look | right | right among others | no name, or open | wrong |\n|---|---|---|---|---|\n";
  for (const bool last : {false, true}) {
    std::array<int, 4> sums{};
    int n = 0;
    for (const Game& game : games) {
      if (game.in_library != in_library) continue;
      ++n;
      if (game.judgements.empty()) {
        ++sums.at(static_cast<std::size_t>(Said::open));
        continue;
      }
      const auto& look = last ? game.judgements.back() : game.judgements.front();
      ++sums.at(static_cast<std::size_t>(said(game, look.found)));
    }
    out += fmt::format("| {} |", last ? "last" : "first");
    for (const int sum : sums) out += fmt::format(" {} |", calib::testing::percent(sum, n));
    out += "\n";
  }
  return out;
}

std::string page(const std::vector<Game>& games) {
  std::vector<double> minutes;
  std::string rows;
  for (const Game& game : games) {
    double sum = 0;
    std::string looks;
    for (const daemon::run::RunJudgement& j : game.judgements) {
      sum += j.minutes;
      looks += (looks.empty() ? "" : " -> ") + j.found;
    }
    if (!game.stuck.empty())
      looks += fmt::format("{}did not end: {}", looks.empty() ? "" : " -> ", game.stuck);
    if (sum > 0) minutes.push_back(sum);
    rows += fmt::format("| {} | {} | {} | {:.0f} | {} |\n", game.seed, game.hidden, looks, sum, game.deeds);
  }
  std::sort(minutes.begin(), minutes.end());
  std::string out =
      "## Effects of the library\n\n" + counts(games, true) + "\n## Laws of no library\n\n" +
      "Right: no effect is named for it, the verdict is neither EXPLAINED nor PARTIAL; whether the formula "
      "is the hidden law is not counted here, and stands in the list below. Among others: PARTIAL, effects "
      "are named that describe a part of it. Open: the run did not end.\n\n" +
      counts(games, false) +
      fmt::format("\n{} of {} runs measured more; of those the median took {:.0f} minutes beside the plan.\n",
                  minutes.size(), games.size(), minutes.empty() ? 0 : minutes[minutes.size() / 2]);
  return out +
         "\n## Every run\n\n| seed | hidden | looks | minutes more | deeds of a hand "
         "|\n|---|---|---|---|---|\n" +
         rows;
}

}  // namespace
}  // namespace mgtd::test

int main(int argc, char** argv) {
  using namespace mgtd::test;
  CLI::App app{"writes docs/until-explained-benchmark.md"};
  int runs = 60;
  std::uint64_t seed = 1;
  std::string output = "docs/until-explained-benchmark.md", folder;
  app.add_option("-o,--output", output)->capture_default_str();
  app.add_option("--runs", runs, "rigs")->capture_default_str();
  app.add_option("--seed", seed, "of the first")->capture_default_str();
  app.add_option("--keep", folder, "existing folder for the runs: SEED-LOOK.mgtrun");
  CLI11_PARSE(app, argc, argv);
  spdlog::set_level(spdlog::level::off);
  ::testing::InitGoogleTest();
  const std::vector<std::uint64_t> seeds = seeds_that_show(seed, runs);
  const std::uint64_t drawn = seeds.empty() ? 0 : seeds.back() - seed + 1;
  const std::string text = fmt::format(
      "# Runs that go on until they are explained\n\nWritten by this command:\n\n"
      "    build/bin/until_explained --runs {} --seed {}\n\n"
      "Each rig hides one effect, drawn from all that the simulated rig knows, 0.7 to 3 times a size "
      "that is worth finding. Only those are played whose effect a run of 157 poses can show by "
      "{:.0f} standard deviations or more: the length of what it does to the readings, less all that "
      "the calibration and the unknowns of the poses can take of it. {} of the {} rigs drawn show "
      "less. The daemon measures its plan of 157 poses, judges it, and goes on for at most {:.0f} "
      "minutes of the rig's time; a simulated hand warms the heads or switches a coil on where it is "
      "asked to. Shares in percent, with intervals of 95 % (Wilson).\n\n",
      runs, seed, kLeastSigmas, drawn - seeds.size(), drawn, kMinutes);
  const std::string result = page(play_all(seeds, folder));
  std::ofstream(output) << text << result;
  return 0;
}
