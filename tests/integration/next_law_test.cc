// SPDX-License-Identifier: Apache-2.0
// A law of no library: discover leaves several formulas, next says what to measure, and both runs together
// name the right one. With the real programs.
#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/checkout.h"
#include "tests/support/child_process.h"
#include "tests/support/whole_file.h"

namespace mgtd::testing {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class NextLaw : public ::testing::Test {
 protected:
  Finished run(std::vector<std::string> words) {
    words[0] = program(words[0]);
    return run_program(std::move(words), dir_.path());
  }
  json ask(std::vector<std::string> words) {
    words.insert(words.begin(), "mgt");
    words.emplace_back("--json");
    const Finished answer = run(std::move(words));
    EXPECT_EQ(answer.exit_code, 0) << answer.err;
    return json::parse(answer.out, nullptr, false);
  }
  /// A rig with a fourth power of its own reading on s3.z; noise by `seed`.
  std::string scenario(int seed, double size_nT = 0.08) {
    const std::string path = file("s" + std::to_string(seed) + ".toml");
    std::ofstream(path) << "[rig]\nname = \"quartic\"\nparameters = \"table6\"\nseed = " << seed
                        << "\n[temperature]\nstart_degC = 20.0\nramp_degC_per_h = 3.0\n"
                           "head_degC = [0.0, 0.3, -0.2, 0.1]\n"
                           "[[effect]]\nname = \"hidden.quartic\"\nwhere = \"s3.z\"\nnT_at_F0 = "
                        << size_nT << "\n";
    return path;
  }
  [[nodiscard]] std::string file(const std::string& name) const { return dir_ / name; }

 private:
  TemporaryDirectory dir_;
};

TEST_F(NextLaw, WhatNextAsksForNamesTheRightFormula) {
  const std::string first = file("first.csv"), list = file("list.csv"), second = file("second.csv");
  ASSERT_EQ(run({"mgt-rig", "table", "--scenario", scenario(13), "-o", first}).exit_code, 0);
  EXPECT_EQ(ask({"discover", first, "--quick"}).at("verdict"), "LAW-SET");

  EXPECT_EQ(ask({"next", first}).at("rival"), "axis.transverse@s3.z")
      << "what explain leaves open comes first";
  const json next = ask({"next", first, "s3.z", "-o", list});
  EXPECT_EQ(next.at("schema"), "mgt.next/1");
  ASSERT_GE(next.at("rivals").size(), 2U);
  EXPECT_EQ(next.at("rivals").at(0).at("formula"), "z^4 at s3.z");
  EXPECT_GT(next.at("rivals").at(0).at("P").get<double>(), next.at("rivals").at(1).at("P").get<double>());
  const json& best = next.at("next").at(0);
  EXPECT_TRUE(best.at("by_the_rig"));
  EXPECT_GT(best.at("separation_after").get<double>(), best.at("separation_before").get<double>());
  EXPECT_FALSE(next.at("left_out").empty());

  const Finished measured = run(
      {"mgt-rig", "table", "--scenario", scenario(113), "--poses", list, "--begin", "2400", "-o", second});
  ASSERT_EQ(measured.exit_code, 0) << measured.err;
  const json both = ask({"discover", first, "--and", second, "--quick"});
  EXPECT_EQ(both.at("verdict"), "LAW");
  EXPECT_EQ(both.at("laws").at(0).at("formulas").at(0).at("formula"), "z^4");
}

TEST_F(NextLaw, FormulasEffectsAndPlacesCanBeNamed) {
  const std::string first = file("first.csv");
  ASSERT_EQ(run({"mgt-rig", "table", "--scenario", scenario(13), "-o", first}).exit_code, 0);
  const json pair = ask({"next", first, "four@s3.z,level=axis,expr=(u/50000)^4", "axis.quadratic"});
  EXPECT_THAT(pair.at("effect").get<std::string>(), HasSubstr("four@s3.z"));
  EXPECT_EQ(pair.at("rival"), "axis.quadratic@s3.z") << "where the formula acts";
  EXPECT_GE(ask({"next", first, "s3.z"}).at("rivals").size(), 2U);
  const json apart = ask({"next", first, "four@s3.z,level=axis,expr=(u/50000)^4", "axis.offset.drift@s3.z"});
  EXPECT_THAT(apart.at("text").get<std::string>(), HasSubstr("tell them apart: there is nothing to settle"));
  const Finished elsewhere = run({"mgt", "next", first, "s1.x"});
  EXPECT_EQ(elsewhere.exit_code, 1);
  EXPECT_THAT(elsewhere.err, HasSubstr("no two formulas open at s1.x"));

  // A formula of the model that was chosen in doubt is asked about against what could stand in its place.
  ASSERT_EQ(run({"mgt", "import", first, "-o", file("run.mgtrun")}).exit_code, 0);
  const auto define = [&](const std::string& name, const std::string& expression) {
    return run({"mgt", "define", file("run.mgtrun"), name, expression, "--scale", "s3.z"}).exit_code;
  };
  ASSERT_EQ(define("four", "(u/50000)^4"), 0);
  ASSERT_EQ(define("six", "(u/50000)^6"), 0);
  ASSERT_EQ(run({"mgt", "add", "four", file("run.mgtrun")}).exit_code, 0);
  const json doubt = ask({"next", file("run.mgtrun")});
  EXPECT_THAT(doubt.at("rivals").dump(), HasSubstr("(u/50000)^4"));
  EXPECT_THAT(doubt.at("rivals").dump(), HasSubstr("(u/50000)^6"));
  EXPECT_FALSE(doubt.at("next").empty());
}

/// A law that the library has only a surrogate for: both commands go on to its formula by themselves.
TEST_F(NextLaw, ExplainAndImproveEndWithTheFormulaOfWhatRemains) {
  const std::string table = file("strong.csv");
  ASSERT_EQ(run({"mgt-rig", "table", "--scenario", scenario(13, 0.3), "-o", table}).exit_code, 0);
  for (const std::string command : {"explain", "improve"}) {
    const json whole = json::parse(run({"mgt", command, table, "--json"}).out, nullptr, false);
    ASSERT_TRUE(whole.contains("law")) << command;
    EXPECT_EQ(whole.at("law").at("schema"), "mgt.discover/1");
    EXPECT_EQ(whole.at("law").at("verdict"), "LAW") << command;
    EXPECT_EQ(whole.at("law").at("laws").at(0).at("formulas").at(0).at("formula"), "z^4");
    const json& commands = whole.at("law").at("commands");
    ASSERT_EQ(commands.size(), 3U) << "no effect that stood in for it: " << command;
    EXPECT_EQ(commands.at(0), "mgt import " + table + " -o " + file("strong.mgtrun"));
    EXPECT_EQ(commands.at(2), "mgt add law1 " + file("strong.mgtrun"));
    EXPECT_EQ(whole.at("law").at("instead_of"), json::array({"axis.quadratic@s3.z"}));
    const json bare = json::parse(run({"mgt", command, table, "--no-law", "--json"}).out, nullptr, false);
    EXPECT_FALSE(bare.contains("law")) << command;
    const Finished text = run({"mgt", command, table});
    EXPECT_EQ(text.exit_code, 1);
    EXPECT_THAT(text.out, HasSubstr("A formula for everything, instead of axis.quadratic@s3.z"));
    EXPECT_THAT(text.out, HasSubstr("LAW: z^4 at s3.z."));
    EXPECT_EQ(bare.at("verdict"), command == "explain" ? "PARTIAL" : whole.at("verdict"));
    if (command == "explain")
      EXPECT_THAT(
          text.out,
          AllOf(::testing::StartsWith("UNKNOWN\n"),
                HasSubstr("axis.quadratic@s3.z is not named: formulas account for everything without it.")));
    EXPECT_THAT(text.out, Not(HasSubstr("shows most of it"))) << "what is left was told one sentence before";
    EXPECT_THAT(run({"mgt", command, table, "--no-law"}).out, Not(HasSubstr("A formula for")));
  }
}

/// A law stands beside the effects that it was searched beside: those are added first. A pose table keeps no
/// model, and the commands make a run file of it.
TEST_F(NextLaw, TheCommandsMakeTheModelThatWasSearched) {
  const std::string table = file("strong.csv");
  ASSERT_EQ(run({"mgt-rig", "table", "--scenario", scenario(13, 0.3), "-o", table}).exit_code, 0);
  const json found = ask({"discover", table, "--quick", "--with", "axis.cubic@s1.x"});
  ASSERT_EQ(found.at("verdict"), "LAW");
  ASSERT_EQ(found.at("commands").size(), 4U);
  EXPECT_EQ(found.at("commands").at(1), "mgt add axis.cubic@s1.x " + file("strong.mgtrun"));
  for (const json& command : found.at("commands")) {
    const std::string words = program("mgt") + command.get<std::string>().substr(3);
    EXPECT_NE(run_program({"/bin/sh", "-c", words}, file("")).exit_code, 2) << command;
  }
}

TEST_F(NextLaw, NoFormulaIsLookedForWhereNothingRemains) {
  const std::string table = file("clean.csv");
  ASSERT_EQ(run({"mgt-rig", "table", "--scenario", scenario(13, 0), "-o", table}).exit_code, 0);
  const json explained = ask({"explain", table});
  EXPECT_EQ(explained.at("verdict"), "PASS");
  EXPECT_TRUE(explained.at("law").is_null());
  EXPECT_TRUE(ask({"improve", table}).at("law").is_null());
}

/// A discovered law stays with the run, with its doubt, and a second run confirms it.
TEST_F(NextLaw, WhatDiscoverKeepsIsConfirmedByASecondRunAndStandsInTheReport) {
  const std::string first = file("first.csv"), second = file("second.csv");
  ASSERT_EQ(run({"mgt-rig", "table", "--scenario", scenario(13), "-o", first}).exit_code, 0);
  ASSERT_EQ(run({"mgt-rig", "table", "--scenario", scenario(113), "-o", second}).exit_code, 0);
  const Finished refused = run({"mgt", "discover", first, "--keep"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("is a pose table, which keeps no model"));
  const std::string run1 = file("first.mgtrun"), run2 = file("second.mgtrun");
  ASSERT_EQ(run({"mgt", "import", first, "-o", run1}).exit_code, 0);
  ASSERT_EQ(run({"mgt", "import", second, "-o", run2}).exit_code, 0);

  const json found = ask({"discover", run1, "--keep"});
  EXPECT_EQ(found.at("kept"), json::array({"law1"}));
  EXPECT_EQ(found.at("commands"), json::array({"mgt add law1 " + run1})) << "it is kept already";
  EXPECT_THAT(found.at("text").get<std::string>(),
              AllOf(HasSubstr("kept in "), HasSubstr("SECOND.mgtrun"), Not(HasSubstr("mgt define " + run1))));
  const json formula = ask({"model", run1}).at("formulas").at(0);
  EXPECT_EQ(formula.at("name"), "law1");
  EXPECT_TRUE(formula.at("exploratory"));
  EXPECT_THAT(formula.at("discovered").get<std::string>(), HasSubstr("(LAW-SET, P 0.8"));

  const json confirmed = ask({"define", run2, "law1", "--from", run1});
  EXPECT_EQ(confirmed.at("confirmed"), true);
  EXPECT_EQ(confirmed.at("discovered"), formula.at("discovered"));
  const std::string quiet = file("quiet.csv"), run3 = file("quiet.mgtrun");
  ASSERT_EQ(run({"mgt-rig", "table", "--scenario", scenario(14, 0), "-o", quiet}).exit_code, 0);
  ASSERT_EQ(run({"mgt", "import", quiet, "-o", run3}).exit_code, 0);
  EXPECT_EQ(run({"mgt", "define", run3, "law1", "--from", run1}).exit_code, 1);
  EXPECT_THAT(run({"mgt", "model", run3}).out, HasSubstr(" (not confirmed here); found by mgt discover"));
  EXPECT_THAT(run({"mgt", "model", run1}).out, HasSubstr(" (exploratory); found by mgt discover"));
  EXPECT_EQ(ask({"discover", run1, "--keep"}).at("kept"), json::array({"law1"})) << "the same again";
  const json added = ask({"add", "law1", run1});
  EXPECT_THAT(added.at("open").get<std::string>(), HasSubstr("max(0"));
  EXPECT_EQ(ask({"model", run1}).at("model").size(), 1U);
  const json next = ask({"next", run1});
  EXPECT_THAT(next.at("rivals").dump(), HasSubstr("max(0")) << "the doubt stays with the model";
  EXPECT_FALSE(next.at("next").empty());

  const std::string page = file("report.html");
  ASSERT_EQ(run({"mgt", "report", run1, "-o", page}).exit_code, 0);
  const std::string text = whole_file(page);
  EXPECT_THAT(text, HasSubstr("<h3>LAW-SET: z^4 at s3.z</h3>"));
  EXPECT_THAT(text, HasSubstr("Shape of the law at s3.z"));
}

/// A fit knows what a sensor read at the pose before; a stream does not.
TEST_F(NextLaw, AddSaysWhichFormulasTheStreamLeavesOut) {
  const std::string table = file("first.csv");
  ASSERT_EQ(run({"mgt-rig", "table", "--scenario", scenario(13), "-o", table}).exit_code, 0);
  const auto said = [&](const std::string& effect) {
    return run({"mgt", "add", effect, table, "--try"}).err;
  };
  EXPECT_THAT(said("before@s3.z,level=axis,expr=prev_u/50000"), HasSubstr("before out of the stream"));
  EXPECT_THAT(said("now@s3.z,level=axis,expr=(u/50000)^4"), Not(HasSubstr("stream")));
  EXPECT_THAT(said("axis.hysteresis@s3.z"), Not(HasSubstr("stream"))) << "followed sample by sample";
}

}  // namespace
}  // namespace mgtd::testing
