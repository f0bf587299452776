// SPDX-License-Identifier: Apache-2.0
// Compare, explain, add, and the error falls: the operator's loop with the real programs.
#include <gmock/gmock.h>

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "proto/error.h"
#include "proto/version.h"
#include "tests/support/checkout.h"
#include "tests/support/child_process.h"
#include "tests/support/whole_file.h"

namespace mgtd::testing {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

const std::string kScenario = source_path("tests/scenarios/hidden_temperature.toml");

/// A run file of a scenario, and mgt on it.
class Loop : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(run({"mgt-rig", "table", "--scenario", kScenario, "--poses", "run157", "-o", file("poses.csv")})
                  .exit_code,
              0);
    ASSERT_EQ(mgt({"import", file("poses.csv"), "-o", run_file()}).exit_code, 0);
  }
  Finished run(std::vector<std::string> words) {
    words[0] = program(words[0]);
    return run_program(std::move(words), dir_.path());
  }
  Finished mgt(std::vector<std::string> words) {
    words.insert(words.begin(), "mgt");
    return run(std::move(words));
  }
  json ask(std::vector<std::string> words) {
    words.emplace_back("--json");
    return json::parse(mgt(std::move(words)).out, nullptr, false);
  }
  [[nodiscard]] std::string file(const std::string& name) const { return dir_ / name; }
  [[nodiscard]] std::string run_file() const { return file("run.mgtrun"); }

 private:
  TemporaryDirectory dir_;
};

const std::string kEffect = "axis.offset.temperature@s3.z";

TEST_F(Loop, TheErrorFallsAndTheModelIsKept) {
  const json before = ask({"fit", run_file()});
  EXPECT_THAT(before.at("effects"), IsEmpty());
  const Finished add = mgt({"add", kEffect, run_file(), "--json"});
  ASSERT_EQ(add.exit_code, 0) << add.err;
  const json change = json::parse(add.out);
  EXPECT_TRUE(change.at("kept"));
  EXPECT_LT(change.at("held_out_after_nT").get<double>(),
            0.1 * change.at("held_out_before_nT").get<double>());
  EXPECT_EQ(change.at("waterfall").at("steps").size(), 1U);
  // Every command uses it, and says so.
  const Finished fit = mgt({"fit", run_file(), "--json"});
  EXPECT_THAT(fit.err, HasSubstr("with the model kept in the run: " + kEffect));
  EXPECT_EQ(json::parse(fit.out).at("effects").at(0).at("effect"), "axis.offset.temperature");
  EXPECT_EQ(mgt({"compare", run_file()}).exit_code, 0);
  EXPECT_EQ(ask({"explain", run_file()}).at("verdict"), "PASS");
  EXPECT_EQ(mgt({"apply", run_file(), file("poses.csv")}).exit_code, 0);
  // And is left when asked.
  EXPECT_THAT(ask({"fit", run_file(), "--with", "none"}).at("effects"), IsEmpty());
}

TEST_F(Loop, HistoryIsKeptAndUndoGoesBack) {
  ASSERT_EQ(mgt({"add", kEffect, run_file()}).exit_code, 0);
  ASSERT_EQ(mgt({"undo", run_file()}).exit_code, 0);
  const json model = ask({"model", run_file()});
  EXPECT_THAT(model.at("model"), IsEmpty());
  ASSERT_EQ(model.at("history").size(), 2U);
  EXPECT_EQ(model.at("history").at(0).at("action"), "add");
  EXPECT_EQ(model.at("history").at(1).at("action"), "undo");
  EXPECT_THAT(model.at("history").at(0).at("who").get<std::string>(), HasSubstr("mgt "));
  EXPECT_EQ(mgt({"undo", run_file()}).exit_code, 1) << "there is nothing left to undo";
}

/// A job of the console runs as the daemon's user and works for somebody else.
TEST_F(Loop, AStepIsOfWhomItIsMadeFor) {
  ASSERT_EQ(mgt({"add", kEffect, run_file(), "--who", "the console, from ::1"}).exit_code, 0);
  ASSERT_EQ(mgt({"mask", run_file(), "3", "--why", "a car", "--who", "the console, from ::2"}).exit_code, 0);
  ASSERT_EQ(mgt({"undo", run_file(), "--who", "the console, from ::3"}).exit_code, 0);
  const json history = ask({"model", run_file()}).at("history");
  ASSERT_EQ(history.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(history.at(i).at("who"), fmt::format("the console, from ::{}, mgt {}", i + 1, version()));
  EXPECT_THAT(mgt({"add", "--help"}).out, Not(HasSubstr("--who")));
}

TEST_F(Loop, WhatIsNeededIsNotDroppedUnlessForced) {
  ASSERT_EQ(mgt({"add", kEffect, run_file()}).exit_code, 0);
  const Finished drop = mgt({"drop", "axis.offset.temperature", run_file()});
  EXPECT_EQ(drop.exit_code, 1);
  EXPECT_THAT(drop.err, HasSubstr("on poses left out the error rises"));
  EXPECT_THAT(ask({"model", run_file()}).at("model"), ElementsAre(kEffect));
  EXPECT_EQ(mgt({"drop", "axis.offset.temperature", run_file(), "--force"}).exit_code, 0);
  EXPECT_THAT(ask({"model", run_file()}).at("model"), IsEmpty());
}

TEST_F(Loop, WhatBelongsToOneRunIsNotAskedOfSeveral) {
  for (const char* command : {"diff", "history"}) {
    const Finished several = mgt({command, run_file(), run_file(), "--without", "3"});
    EXPECT_EQ(several.exit_code, 2) << command;
    EXPECT_THAT(several.err, HasSubstr("--without")) << command;
  }
}

TEST_F(Loop, ARefusalHasItsRemedyAndChangesNothing) {
  const Finished csv = mgt({"add", kEffect, file("poses.csv")});
  EXPECT_EQ(csv.exit_code, 2);
  EXPECT_THAT(csv.err, HasSubstr("mgt import"));
  const Finished unknown = mgt({"add", "axis.nonsense", run_file()});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("known effects"));
  EXPECT_EQ(mgt({"drop", kEffect, run_file()}).exit_code, 1);
  EXPECT_THAT(ask({"model", run_file()}).at("history"), IsEmpty());
}

#ifndef MGTD_SANITIZED  // sanitizers reserve terabytes
TEST_F(Loop, TooLittleMemoryIsAnErrorWithARemedy) {
  std::ofstream table(file("long.csv"));
  table << "pose,s1_x_nT,s1_y_nT,s1_z_nT,f_nT\n";
  for (int k = 0; k < 100'000; ++k) table << k << ",30000,20000,34641,50000\n";
  table.close();
  const Finished fit =
      run_program({"/bin/sh", "-c", "ulimit -v 150000; OPENBLAS_NUM_THREADS=1 exec \"$0\" fit \"$1\"",
                   program("mgt"), file("long.csv")},
                  ".");
  EXPECT_EQ(fit.exit_code, exit_code(ErrorCode::io)) << fit.err;
  EXPECT_THAT(fit.err, HasSubstr("there is not enough memory for this"));
  EXPECT_THAT(fit.err, HasSubstr("raise the limit of this one"));
}
#endif

TEST_F(Loop, AFormulaIsExaminedKeptAndUsedByItsName) {
  const Finished define =
      mgt({"define", run_file(), "warmth", "T_degC - 20", "--scale", "s3.z", "--unit", "nT/degC", "--json"});
  ASSERT_EQ(define.exit_code, 0) << define.err;
  const json examined = json::parse(define.out);
  EXPECT_EQ(examined.at("resembles").at(0).at("effect"), "axis.offset.temperature");
  EXPECT_TRUE(examined.at("exploratory"));
  // explain has it among its candidates too, and says what it is worth here.
  const Finished explain = mgt({"explain", run_file(), "--json"});
  EXPECT_THAT(explain.err, HasSubstr("warmth was suggested by this run"));
  EXPECT_THAT(explain.out, HasSubstr("\"effect\":\"warmth\""));
  EXPECT_THAT(mgt({"improve", run_file(), "--no-law"}).err, HasSubstr("warmth was suggested by this run"));
  EXPECT_THAT(mgt({"next", run_file()}).err, HasSubstr("warmth was suggested by this run"));
  ASSERT_EQ(mgt({"add", "warmth", run_file()}).exit_code, 0);
  ASSERT_EQ(mgt({"fit", run_file(), "-o", file("cal.json")}).exit_code, 0);
  EXPECT_THAT(whole_file(file("cal.json")), HasSubstr("expr=T_degC - 20"));
  EXPECT_EQ(mgt({"apply", file("cal.json"), file("poses.csv")}).exit_code, 0) << "complete in itself";
  EXPECT_EQ(ask({"fit", run_file(), "--with", "none", "--with", "warmth@s2.x"}).at("effects").size(), 1U);
}

TEST_F(Loop, ASecondRunConfirmsAFormula) {
  ASSERT_EQ(mgt({"define", run_file(), "warmth", "T_degC - 20", "--scale", "s3.z"}).exit_code, 0);
  std::string scenario = whole_file(kScenario);
  scenario.replace(scenario.find("seed = 12"), 9, "seed = 77");
  std::ofstream(file("second.toml")) << scenario;
  ASSERT_EQ(run({"mgt-rig", "table", "--scenario", file("second.toml"), "-o", file("second.csv")}).exit_code,
            0);
  ASSERT_EQ(mgt({"import", file("second.csv"), "-o", file("second.mgtrun")}).exit_code, 0);
  const json confirmed = ask({"define", file("second.mgtrun"), "warmth", "--from", run_file()});
  EXPECT_TRUE(confirmed.at("confirmed")) << confirmed.dump();
  EXPECT_FALSE(confirmed.at("exploratory"));
}

TEST_F(Loop, AFormulaWithAMistakeIsShownWhereItIs) {
  const Finished typo = mgt({"define", run_file(), "a", "2*T_degc"});
  EXPECT_EQ(typo.exit_code, 2);
  EXPECT_THAT(typo.err, HasSubstr("column 3: no pose has a 'T_degc'"));
  const Finished library = mgt({"define", run_file(), "site.gradient", "t_h"});
  EXPECT_EQ(library.exit_code, 2);
  const Finished absorbed = mgt({"define", run_file(), "iron", "u/1000", "--scale", "s1.x"});
  EXPECT_EQ(absorbed.exit_code, 1);
  EXPECT_THAT(absorbed.out, HasSubstr("absorbs it whole"));
}

TEST_F(Loop, TheNextMeasurementThatWouldSettleAPair) {
  const Finished next = mgt(
      {"next", run_file(), "axis.offset.temperature", "axis.offset.drift", "--json", "-o", file("list.csv")});
  ASSERT_EQ(next.exit_code, 0) << next.err;
  const json asked = json::parse(next.out);
  EXPECT_EQ(asked.at("schema"), "mgt.next/1");
  const json& best = asked.at("next").at(0);
  EXPECT_GT(best.at("p_right_after").get<double>(), asked.at("p_right_before").get<double>());
  EXPECT_GT(best.at("minutes").get<double>(), 0);
  for (std::size_t i = 1; i < asked.at("next").size(); ++i)
    EXPECT_LE(asked.at("next").at(i).at("p_right_after"), asked.at("next").at(i - 1).at("p_right_after"));
  // What it wrote is a list that the planner reads.
  EXPECT_THAT(whole_file(file("list.csv")), HasSubstr("pose,set,azimuth_deg"));
  EXPECT_NE(mgt({"plan", file("list.csv")}).exit_code, 2);
  const Finished one = mgt({"next", run_file(), "axis.cubic"});
  EXPECT_EQ(one.exit_code, 2);
  const Finished iron = mgt({"next", run_file(), "axis.cubic", "platform.hard-iron"});
  EXPECT_EQ(iron.exit_code, 1);
  EXPECT_THAT(iron.err, HasSubstr("cannot be tested on this run"));
}

TEST_F(Loop, TheReportIsOnePageThatNeedsNothingElse) {
  ASSERT_EQ(mgt({"add", kEffect, run_file()}).exit_code, 0);
  const Finished report = mgt({"report", run_file(), "-o", file("report.html"), "--json"});
  ASSERT_EQ(report.exit_code, 0) << report.err;
  EXPECT_EQ(json::parse(report.out).at("verdict"), "PASS");
  const std::string page = whole_file(file("report.html"));
  EXPECT_THAT(page, HasSubstr("<!doctype html>"));
  EXPECT_THAT(page, HasSubstr("What good looks like"));
  EXPECT_THAT(page, HasSubstr("What each effect takes out"));
  EXPECT_THAT(page, HasSubstr("How the model came to be"));
  EXPECT_THAT(page, HasSubstr("The effects of the model are taken out of it"))
      << "the time axis shows what is left";
  for (const char* loaded : {"<script", "src=", "href=", "url(", "@import"})
    EXPECT_EQ(page.find(loaded), std::string::npos) << loaded;
  EXPECT_EQ(mgt({"report", file("none.csv"), "-o", file("x.html")}).exit_code, 2);
  EXPECT_EQ(whole_file(file("x.html")), "");
}

}  // namespace
}  // namespace mgtd::testing
