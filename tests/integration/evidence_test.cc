// SPDX-License-Identifier: Apache-2.0
// What the pictures are drawn from, by the real programs: residuals by pose, the evidence for one effect,
// poses that an operator leaves out.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/support/checkout.h"
#include "tests/support/child_process.h"
#include "tests/support/whole_file.h"

namespace mgtd::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

class EvidenceOfPrograms : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string scenario = source_path("tests/scenarios/hidden_temperature.toml");
    ASSERT_EQ(run({"mgt-rig", "table", "--scenario", scenario, "--poses", "run157", "-o", dir_ / "poses.csv"})
                  .exit_code,
              0);
    ASSERT_EQ(mgt({"import", dir_ / "poses.csv", "-o", file()}).exit_code, 0);
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
  [[nodiscard]] std::string file() const { return dir_ / "run.mgtrun"; }
  [[nodiscard]] std::string folder(const std::string& name) const { return dir_ / name; }

 private:
  TemporaryDirectory dir_;
};

TEST_F(EvidenceOfPrograms, EveryPoseHasItsResiduals) {
  const json plain = ask({"compare", file()});
  EXPECT_FALSE(plain.contains("poses") && plain.at("poses").is_object()) << "only where it is asked for";
  const json compared = ask({"compare", file(), "--poses"});
  const json& poses = compared.at("poses");
  for (const char* key :
       {"pose", "residual_nT", "whitened", "scalar_nT", "attitude_deg", "closure", "left_out", "leverage"})
    ASSERT_TRUE(poses.contains(key)) << key;
  EXPECT_EQ(poses.at("pose").size(), 157U);
  EXPECT_EQ(poses.at("leverage").size(), 157U);
}

TEST_F(EvidenceOfPrograms, TheHiddenEffectIsALineThroughManyPoses) {
  const json why = ask({"why", "axis.offset.temperature", file()});
  EXPECT_EQ(why.at("schema"), "mgt.why/1");
  EXPECT_EQ(why.at("candidate").at("effect"), "axis.offset.temperature");
  const Finished text = mgt({"why", "axis.offset.temperature", file(), "--at", "s3.z"});
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("axis.offset.temperature"));
  EXPECT_THAT(mgt({"why", "axis.ofset.temperature", file()}).err,
              HasSubstr("did you mean 'axis.offset.temperature'?"));
}

TEST_F(EvidenceOfPrograms, AMaskedPoseIsLeftOutByEveryCommandUntilItIsTakenInAgain) {
  const int all = ask({"fit", file()}).at("poses");
  EXPECT_EQ(mgt({"mask", file(), "3"}).exit_code, 2) << "a reason is needed";
  EXPECT_EQ(mgt({"mask", file(), "999", "--why", "a car"}).exit_code, 2);
  const json masked = ask({"mask", file(), "3", "7-9", "--why", "a car stood beside the rig"});
  EXPECT_EQ(masked.at("masked"), json({3, 7, 8, 9}));
  EXPECT_EQ(ask({"fit", file()}).at("poses"), all - 4);
  EXPECT_THAT(mgt({"model", file()}).out, HasSubstr("a car stood beside the rig"));
  const std::string exported = mgt({"export", file()}).out;
  EXPECT_EQ(std::count(exported.begin(), exported.end(), '\n'), 158) << "a copy has every pose";
  EXPECT_EQ(ask({"unmask", file(), "7-9"}).at("masked"), json({3}));
  EXPECT_EQ(ask({"fit", file()}).at("poses"), all - 1);
  EXPECT_EQ(mgt({"undo", file()}).exit_code, 0);
  EXPECT_EQ(ask({"fit", file()}).at("poses"), all - 4) << "the mask as it was before";
  EXPECT_EQ(ask({"fit", file(), "--without", "100"}).at("poses"), all - 5);
  const json kept = ask({"fit", file(), "--keep-all"});
  EXPECT_THAT(kept.at("checks").dump(), HasSubstr("not asked: every reading was to be kept"));
  EXPECT_EQ(ask({"fit", file()}).at("poses"), all - 4) << "tried, not kept";
}

/// Where the fit is refused for two reasons, the poses of one are masked after those of the other.
TEST_F(EvidenceOfPrograms, PosesAreMaskedWhileTheFitOfTheOthersIsRefused) {
  const json few = ask({"mask", file(), "6-157", "--why", "the cable was loose"});
  EXPECT_EQ(few.at("masked").size(), 152U);
  EXPECT_TRUE(few.at("rms_after_nT").is_null());
  EXPECT_THAT(few.at("refused").get<std::string>(), HasSubstr("poses"));
  EXPECT_THAT(mgt({"model", file()}).out, HasSubstr(" nT -> refused"));
  const json all = ask({"unmask", file(), "6-157"});
  EXPECT_TRUE(all.at("rms_before_nT").is_null());
  EXPECT_GT(all.at("rms_after_nT").get<double>(), 0);
  EXPECT_EQ(mgt({"report", file(), "-o", file() + ".html"}).exit_code, 0);
  EXPECT_THAT(whole_file(file() + ".html"), HasSubstr("refused → "));
}

/// The reason is typed by a person and stands in a page: it is text there, whatever it says.
TEST_F(EvidenceOfPrograms, TheReportTellsWhichPosesAreMaskedAndWhy) {
  const auto reported = [&] {
    EXPECT_EQ(mgt({"report", file(), "-o", file() + ".html"}).exit_code, 0);
    return whole_file(file() + ".html");
  };
  ASSERT_EQ(mgt({"mask", file(), "3", "7-9", "--why", "a <b>car</b> stood beside the rig"}).exit_code, 0);
  const std::string page = reported();
  for (const char* pose : {"3", "7", "8", "9"})
    EXPECT_THAT(page, HasSubstr(std::string("<td>") + pose +
                                "</td><td>a &lt;b&gt;car&lt;/b&gt; stood beside the rig</td>"));
  EXPECT_THAT(page, HasSubstr("<td>mask</td><td>3,7-9</td>")) << "the history";
  EXPECT_EQ(page.find("<b>car"), std::string::npos);
  ASSERT_EQ(mgt({"unmask", file(), "3", "7-9"}).exit_code, 0);
  const std::string whole = reported();
  EXPECT_EQ(whole.find("</td><td>a &lt;b&gt;car"), whole.rfind("</td><td>a &lt;b&gt;car"))
      << "in the history alone";
  EXPECT_THAT(whole, HasSubstr("<td>unmask</td>"));
}

/// A page draws the panels itself; what stands beside them is said here.
TEST_F(EvidenceOfPrograms, PanelsAndFiguresHaveTheirWords) {
  const json compared = ask({"compare", file(), "--poses"});
  ASSERT_EQ(compared.at("panels").size(), 9U);
  for (const json& panel : compared.at("panels"))
    EXPECT_THAT(panel.at("good").get<std::string>(), HasSubstr("Here "));
  EXPECT_EQ(compared.at("panels").at(0).at("stands_out"), true) << "the residual follows the time";
  const json& quantiles = compared.at("quantiles");
  EXPECT_EQ(quantiles.at("pose").size(), quantiles.at("residual").size());
  EXPECT_EQ(compared.at("autocorrelation").at("by_sensor").size(), 4U);
  EXPECT_EQ(ask({"explain", file(), "--confusion"}).at("figures").size(), 3U);
  EXPECT_FALSE(ask({"explain", file()}).contains("figures"));
}

/// Every command that computes something worth drawing draws it: in its object, and in a folder.
TEST_F(EvidenceOfPrograms, FiguresComeWithTheirWordsAndTheirData) {
  const std::string effect = "axis.offset.temperature@s3.z";
  const std::vector<std::pair<std::vector<std::string>, std::vector<std::string>>> commands{
      {{"compare", file()}, {"residual-time", "skies", "qq", "coverage", "time", "closure"}},
      {{"explain", file(), "--confusion"}, {"candidates", "evidence", "detectable", "confusion"}},
      {{"why", effect, file()}, {"evidence"}},
      {{"add", effect, file(), "--try"}, {"waterfall", "price", "impact"}},
      {{"plan"}, {"coverage", "detectable"}},
      {{"define", file(), "warm", "T_degC", "--scale", "s3.z", "--try"}, {"signature"}}};
  for (const auto& [command, names] : commands) {
    std::vector<std::string> words = command;
    words.push_back("--figures=" + folder(command.front()));
    const json figures = ask(std::move(words)).at("figures");
    for (const std::string& name : names) {
      ASSERT_TRUE(figures.contains(name))
          << command.front() << ": " << name << " is not in " << figures.size();
      const json& figure = figures.at(name);
      EXPECT_THAT(figure.at("svg").get<std::string>(), HasSubstr("</svg>")) << name;
      EXPECT_THAT(figure.at("good").get<std::string>(), HasSubstr("Here")) << name;
      const json& points = figure.at("points");
      ASSERT_FALSE(points.at("rows").empty()) << name;
      for (const json& row : points.at("rows")) EXPECT_EQ(row.size(), points.at("head").size()) << name;
      EXPECT_TRUE(whole_file(folder(command.front()) + "/" + name + ".svg") ==
                  figure.at("svg").get<std::string>())
          << name;
    }
  }
}

TEST_F(EvidenceOfPrograms, AFormulaThatIsAbsorbedWholeHasNoFigure) {
  const json defined = ask({"define", file(), "flat", "1", "--scale", "s3.z", "--try", "--figures"});
  EXPECT_EQ(defined.at("figures"), json::object());
}

TEST_F(EvidenceOfPrograms, FiguresThatNobodyWouldGetAreRefusedAtOnce) {
  const Finished refused = mgt({"explain", file(), "--figures"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("--figures=FOLDER"));
  const Finished no_folder = mgt({"compare", file(), "--figures=" + file()});
  EXPECT_THAT(no_folder.err, HasSubstr("cannot be made"));
  EXPECT_TRUE(no_folder.out.empty());
}

TEST_F(EvidenceOfPrograms, ATryTellsAllAndKeepsNothing) {
  const json tried = ask({"add", "axis.offset.temperature@s3.z", file(), "--try"});
  EXPECT_EQ(tried.at("kept"), false);
  EXPECT_EQ(tried.at("vetoed"), false);
  const json history = ask({"model", file()}).at("history");
  EXPECT_TRUE(history.empty()) << history;
  const json added = ask({"add", "axis.offset.temperature@s3.z", file()});
  for (const char* key : {"rms_after_nT", "held_out_after_nT", "predicted_fall", "realised_fall"})
    EXPECT_EQ(tried.at(key), added.at(key)) << key;
  EXPECT_EQ(ask({"drop", "axis.offset.temperature", file(), "--try"}).at("vetoed"), true);
  EXPECT_EQ(ask({"model", file()}).at("model").size(), 1U);
}

TEST_F(EvidenceOfPrograms, ATryTakesAPoseTable) {
  const std::string table = file().substr(0, file().rfind('/')) + "/poses.csv";
  EXPECT_EQ(mgt({"add", "axis.offset.temperature@s3.z", table}).exit_code, 2) << "it keeps no model";
  EXPECT_EQ(ask({"add", "axis.offset.temperature@s3.z", table, "--try"}).at("vetoed"), false);
  const json tried = ask({"define", table, "warm", "T_degC", "--try"});
  EXPECT_EQ(tried.at("kept"), false);
  EXPECT_EQ(tried.at("signature").at("x").size(), 157U);
  EXPECT_THAT(tried.at("text").get<std::string>(), HasSubstr("axis.offset.temperature"));
}

TEST_F(EvidenceOfPrograms, WhatToMeasureNextIsARun) {
  const json next = ask({"next", file(), "--poses"});
  const json& step = next.at("next").at(0);
  EXPECT_EQ(step.at("run").at("poses").size(), step.at("poses").get<std::size_t>());
  EXPECT_TRUE(step.at("run").at("poses").at(0).contains("azimuth_deg"));
}

TEST_F(EvidenceOfPrograms, AVetoHasItsReason) {
  const json refused = ask({"add", "axis.cubic", file(), "--try"});
  EXPECT_EQ(refused.at("vetoed"), true);
  EXPECT_THAT(refused.at("veto_reasons").at(0).get<std::string>(), HasSubstr("the limit is"));
}

}  // namespace
}  // namespace mgtd::testing
