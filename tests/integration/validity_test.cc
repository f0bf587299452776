// SPDX-License-Identifier: Apache-2.0
// mgt plan, check and diff as an operator uses them, on pose tables of the simulated rig.
#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/support/checkout.h"
#include "tests/support/child_process.h"
#include "tests/support/whole_file.h"

namespace mgtd::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

class Validity : public ::testing::Test {
 protected:
  /// A clean rig's run; another seed is another day.
  void measure(const std::string& file, int seed) {
    std::ofstream(dir_ / "rig.toml") << "[rig]\nname = \"r\"\nparameters = \"table6\"\nseed = " << seed
                                     << "\n";
    table_of("rig", file);
  }
  /// What the rig of NAME.toml measures: NAME.csv, or `file`.
  void table_of(const std::string& name, const std::string& file = "") {
    const Finished made = run_program({program("mgt-rig"), "table", "--scenario", dir_ / (name + ".toml"),
                                       "-o", dir_ / (file.empty() ? name + ".csv" : file)},
                                      dir_.path());
    ASSERT_EQ(made.exit_code, 0) << made.err;
  }
  /// Header and twelve of the random poses; `shift_nT` is added to s3_z_nT.
  void dozen(const std::string& from, const std::string& to, double shift_nT) {
    std::istringstream in(whole_file(dir_ / from));
    std::ofstream out(dir_ / to);
    std::string line;
    std::getline(in, line);
    out << line << "\n";
    std::istringstream header(line);
    int column = 0;
    for (std::string name; std::getline(header, name, ',') && name != "s3_z_nT";) ++column;
    for (int row = 0; std::getline(in, line); ++row) {
      if (row < 60 || row >= 72) continue;
      std::istringstream cells(line);
      std::string cell;
      for (int c = 0; std::getline(cells, cell, ','); ++c)
        out << (c == 0 ? "" : ",") << (c == column ? std::to_string(std::stod(cell) + shift_nT) : cell);
      out << "\n";
    }
  }
  Finished mgt(std::vector<std::string> words) {
    words.insert(words.begin(), program("mgt"));
    return run_program(std::move(words), dir_.path());
  }
  TemporaryDirectory dir_;
};

TEST_F(Validity, LastWeeksCalibrationAgainstADozenPoses) {
  measure("monday.csv", 1);
  measure("friday.csv", 2);
  ASSERT_EQ(mgt({"fit", dir_ / "monday.csv", "-o", dir_ / "cal.json"}).exit_code, 0);
  dozen("friday.csv", "same.csv", 0);
  dozen("friday.csv", "moved.csv", 1);
  const Finished same = mgt({"check", dir_ / "cal.json", dir_ / "same.csv"});
  EXPECT_EQ(same.exit_code, 0) << same.out;
  EXPECT_THAT(same.out, HasSubstr("VALID"));
  EXPECT_THAT(same.out, HasSubstr("smallest change that these poses show"));
  const Finished moved = mgt({"check", dir_ / "cal.json", dir_ / "moved.csv", "--json"});
  EXPECT_EQ(moved.exit_code, 1);
  const json report = json::parse(moved.out);
  EXPECT_FALSE(report.at("valid").get<bool>());
  EXPECT_EQ(report.at("change").at("named").at(0).at("name"), "s3 iz");
}

TEST_F(Validity, TwoRunsAndAFileOfACalibration) {
  measure("monday.csv", 1);
  measure("friday.csv", 2);
  ASSERT_EQ(mgt({"fit", dir_ / "monday.csv", "-o", dir_ / "cal.json"}).exit_code, 0);
  const Finished same = mgt({"diff", dir_ / "cal.json", dir_ / "friday.csv", "--json"});
  EXPECT_EQ(same.exit_code, 0) << same.out << same.err;
  EXPECT_FALSE(json::parse(same.out).at("changed").get<bool>());
  const Finished wrong = mgt({"diff", dir_ / "rig.toml", dir_ / "friday.csv"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("rig.toml:1:1"));
}

TEST_F(Validity, APlanBeforeAnythingIsMeasured) {
  const Finished plan = mgt({"plan", "--with", "site.gradient", "--json"});
  ASSERT_EQ(plan.exit_code, 0) << plan.err;
  const json report = json::parse(plan.out);
  EXPECT_EQ(report.at("poses"), 157);
  EXPECT_EQ(report.at("parameters").size(), 53U);
  EXPECT_GT(report.at("detectable_above").size(), 20U);
  EXPECT_GT(report.at("detectable_above")[0].at("sd"), 0.0);
  bool square = false;
  for (const json& pair : report.at("inseparable"))
    square = square || (pair.at("effect") == "axis.quadratic" && pair.at("rival") == "axis.transverse" &&
                        pair.at("correlation") > 0.999 && pair.at("remedy").at("p_right") > 0.95);
  EXPECT_TRUE(square);
  EXPECT_EQ(mgt({"plan", "--config", source_path("systemd/mgtd.toml")}).exit_code, 0);
  std::ofstream level(dir_ / "level.csv");
  level << "pose,azimuth_deg,pitch_deg,roll_deg\n";
  for (int k = 1; k <= 36; ++k) level << k << "," << 10 * k << ",0,0\n";
  level.close();
  const Finished one_axis = mgt({"plan", dir_ / "level.csv"});
  EXPECT_EQ(one_axis.exit_code, 1);
  EXPECT_THAT(one_axis.out, HasSubstr("not at all"));
  EXPECT_THAT(one_axis.out, HasSubstr("needs t_s"));
}

/// A table that was measured says how many sensors it is of.
TEST_F(Validity, APlanForTheTableOfOneSensor) {
  std::ofstream(dir_ / "one.toml")
      << "[rig]\nparameters = \"random\"\nseed = 3\n[array]\npositions_m = [[0, 0, 0]]\n";
  table_of("one");
  const Finished plan = mgt({"plan", dir_ / "one.csv", "--json"});
  ASSERT_EQ(plan.exit_code, 0) << plan.err;
  const json report = json::parse(plan.out);
  EXPECT_EQ(report.at("parameters").size(), 12U);
  EXPECT_TRUE(report.at("tensor_sd_nT_per_m").at("xx").is_null());
  EXPECT_GT(report.at("field_sd_nT"), 0.0);
  for (const json& pose : report.at("helpful")) EXPECT_GT(pose.at("variance_share"), 0.0);
}

/// A run file says where its sensors stand, too.
TEST_F(Validity, APlanForARunFileOfTwoSensors) {
  std::ofstream(dir_ / "two.toml") << "[rig]\nparameters = \"random\"\nseed = 3\n[array]\npositions_m = "
                                      "[[0.25, 0, 0], [-0.25, 0, 0]]\n";
  std::ofstream(dir_ / "array.toml") << "[array]\npositions_m = [[0.25, 0, 0], [-0.25, 0, 0]]\n";
  table_of("two");
  const std::string run = dir_ / "two.mgtrun";
  ASSERT_EQ(mgt({"import", dir_ / "two.csv", "--array", dir_ / "array.toml", "-o", run}).exit_code, 0);
  const Finished plan = mgt({"plan", run, "--json"});
  ASSERT_EQ(plan.exit_code, 0) << plan.err;
  EXPECT_EQ(json::parse(plan.out).at("parameters").size(), 24U);
  EXPECT_TRUE(json::parse(plan.out).at("tensor_sd_nT_per_m").at("yy").is_null());
}

TEST_F(Validity, APlanForACoilCageIsRefused) {
  std::ofstream(dir_ / "cage.csv") << "pose,ref_x_nT,ref_y_nT,ref_z_nT,ref_sd_nT\n1,50000,0,0,0.5\n";
  const Finished plan = mgt({"plan", dir_ / "cage.csv"});
  EXPECT_EQ(plan.exit_code, 2);
  EXPECT_THAT(plan.err, HasSubstr("fields of a coil cage (ref_x_nT) and no table angles"));
}

}  // namespace
}  // namespace mgtd::testing
