// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/config.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>

#include "tests/support/checkout.h"
#include "tests/unit/daemon/temp_dir.h"

namespace mgtd::daemon::config {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(Config, EveryMistakeIsReportedAtOnceWithItsLine) {
  const auto config = parse_config(
      "[rig]\n"
      "basline_m = 0.4\n"  // line 2
      "[site]\n"
      "field_nT = \"strong\"\n"  // line 4
      "[run]\n"
      "step_deg = 15\n"  // line 6
      "[cellar]\n"       // line 7
      "wine = 1\n",
      "rig.toml");
  ASSERT_FALSE(config);
  const auto& lines = config.error().lines;
  EXPECT_THAT(
      lines, Contains(HasSubstr("rig.toml:2:1: [rig]: unknown key 'basline_m', did you mean 'baseline_m'?")));
  EXPECT_THAT(lines, Contains(HasSubstr("rig.toml:4:1: [site]: 'field_nT' must be a number")));
  EXPECT_THAT(lines, Contains(HasSubstr("rig.toml:6:1: [run]: 'step_deg': must be 10 or 20 deg")));
  EXPECT_THAT(lines, Contains(StartsWith("rig.toml:7:2: unknown section 'cellar'")));
  EXPECT_THAT(lines, Contains(HasSubstr("four [[sensor]] sections are needed")));
  EXPECT_THAT(lines, Contains(HasSubstr("the [table] section is missing")));
}

TEST(Config, BrokenTomlIsNamedWithLineAndColumn) {
  const auto config = parse_config("[rig\nname = 1\n", "rig.toml");
  ASSERT_FALSE(config);
  ASSERT_EQ(config.error().lines.size(), 1U);
  EXPECT_THAT(config.error().lines[0], StartsWith("rig.toml:1:"));
}

TEST(Config, AFileThatIsNotThereSaysWhatToDo) {
  const auto config = load_config("/nonexistent/mgtd.toml");
  ASSERT_FALSE(config);
  EXPECT_THAT(config.error().lines.at(0), HasSubstr("--config"));
}

TEST(Config, OneSerialNumberIsOneDevice) {
  const auto config = parse_config(
      "[[sensor]]\ndriver = \"obsdaq\"\nport = \"/dev/a\"\nprofile = \"mag-13-100\"\nserial = \"1001\"\n"
      "[[sensor]]\ndriver = \"obsdaq\"\nport = \"/dev/b\"\nprofile = \"mag-13-100\"\nserial = \"1001\"\n",
      "rig.toml");
  ASSERT_FALSE(config);
  EXPECT_THAT(config.error().lines, Contains(HasSubstr("rig.toml:10:1: [[sensor]] s2: 'serial': '1001' is "
                                                       "already used in line 5")));
}

TEST(Config, AnAddressWithoutAPossiblePortIsRefused) {
  for (const char* tcp : {"127.0.0.1:99999", "127.0.0.1:-1", "127.0.0.1", "127.0.0.1:http"}) {
    const auto config = parse_config(std::string("[stream]\ntcp = \"") + tcp + "\"\n", "rig.toml");
    ASSERT_FALSE(config);
    EXPECT_THAT(config.error().lines, Contains(StartsWith("rig.toml:2:1: [stream]: 'tcp'"))) << tcp;
  }
  const auto good = parse_config("[stream]\ntcp = \"127.0.0.1:0\"\n", "rig.toml");
  EXPECT_THAT(good.error().lines, ::testing::Not(Contains(HasSubstr("'tcp'"))));
}

TEST(Config, AnInputIsNoColumnThatIsThereAlready) {
  const auto config = parse_config(
      "[[sensor]]\ndriver = \"obsdaq\"\nport = \"/dev/a\"\nprofile = \"mag-13-100\"\ntemperature = \"p\"\n"
      "degC_per_V = 10.0\ninputs.q = {unit = \"V\", name = \"pose\"}\n  [sensor.inputs.r]\n"
      "  name = \"t_h\"\n  unit = \"V\"\n"
      "[[auxiliary]]\ndriver = \"dcon\"\nport = \"/dev/d\"\n"
      "channels = [\"f_nT\", \"s1_T_degC\", \"s2_T_degC\", \"motor_A\", \"s3_sd_x_nT\", \"motor_A\"]\n"
      "[[auxiliary]]\ndriver = \"dcon\"\nport = \"/dev/e\"\nchannels = [\"motor_A\", \"azimuth_deg\"]\n",
      "rig.toml");
  ASSERT_FALSE(config);
  const auto& lines = config.error().lines;
  EXPECT_THAT(lines,
              Contains(HasSubstr("rig.toml:7:25: [[sensor]] s1: 'inputs.q.name': 'pose' is a column")));
  EXPECT_THAT(lines, Contains(HasSubstr("rig.toml:9:3: [[sensor]] s1: 'inputs.r.name': 't_h' means something "
                                        "else in formulas; choose another name")));
  EXPECT_THAT(lines,
              Contains(HasSubstr("rig.toml:14:1: [[auxiliary]] aux1: 'channels': 'f_nT' is a column")));
  EXPECT_THAT(lines,
              Contains(HasSubstr("rig.toml:14:1: [[auxiliary]] aux1: 'channels': 's1_T_degC' is already "
                                 "measured (s1, input p, in line 5); leave one of the two out")));
  EXPECT_THAT(lines, Contains(HasSubstr("'s3_sd_x_nT' is a column")));
  EXPECT_THAT(lines,
              Contains(HasSubstr("rig.toml:14:1: [[auxiliary]] aux1: 'channels': 'motor_A' is already "
                                 "measured (aux1, input 3, in line 14); give one of them another name")));
  EXPECT_THAT(lines, Contains(HasSubstr("rig.toml:18:1: [[auxiliary]] aux2: 'channels': 'motor_A' is already "
                                        "measured (aux1, input 3, in line 14)")));
  EXPECT_THAT(lines, Contains(HasSubstr("'azimuth_deg' is a column")));
  EXPECT_THAT(lines, ::testing::Not(Contains(HasSubstr("'s2_T_degC'"))));
}

TEST(Config, AWrongTypeIsToldOnceAndACalmTooShortAtItsOwnLine) {
  const auto config = parse_config(
      "[[sensor]]\ndriver = \"obsdaq\"\nport = \"/dev/a\"\nprofile = \"mag-13-100\"\nserial = 1001\n"
      "[run]\ncalm_s = -1\ncalm_max_s = 60\n",
      "rig.toml");
  ASSERT_FALSE(config);
  const auto& lines = config.error().lines;
  EXPECT_EQ(std::count_if(lines.begin(), lines.end(),
                          [](const std::string& l) { return l.find("'serial'") != std::string::npos; }),
            1);
  EXPECT_THAT(lines, Contains(StartsWith("rig.toml:7:1: [run]: 'calm_s'")));
  EXPECT_THAT(lines, ::testing::Not(Contains(HasSubstr("'calm_max_s'"))));
}

TEST(Config, AnUnknownDriverIsRefused) {
  const auto config = parse_config("[table]\ndriver = \"bartington\"\nport = \"/dev/x\"\n", "rig.toml");
  ASSERT_FALSE(config);
  EXPECT_THAT(config.error().lines,
              Contains(HasSubstr("rig.toml:2:1: [table]: 'driver': no such driver here")));
}

TEST(Config, TheCommentedExampleIsAcceptedAndItsDefaultsAreTheDefaults) {
  const auto config = load_config(mgtd::testing::source_path("systemd/mgtd.toml"));
  ASSERT_TRUE(config) << config.error().lines.front();
  const Config untouched;
  EXPECT_EQ(config->baseline_m, untouched.baseline_m);
  EXPECT_EQ(config->rate_hz, untouched.rate_hz);
  EXPECT_EQ(config->site.table_sd_deg, untouched.site.table_sd_deg);
  EXPECT_EQ(config->site.field_nT, untouched.site.field_nT);
  EXPECT_EQ(config->site.field_sd_nT, untouched.site.field_sd_nT);
  EXPECT_EQ(config->run.step_deg, untouched.run.step_deg);
  EXPECT_EQ(config->run.random, untouched.run.random);
  EXPECT_EQ(config->run.revisits, untouched.run.revisits);
  EXPECT_EQ(config->run.dwell_short_s, untouched.run.dwell_short_s);
  EXPECT_EQ(config->run.dwell_long_s, untouched.run.dwell_long_s);
  EXPECT_EQ(config->run.settle_min_s, untouched.run.settle_min_s);
  EXPECT_EQ(config->run.settle_max_s, untouched.run.settle_max_s);
  EXPECT_EQ(config->run.preflight_s, untouched.run.preflight_s);
  EXPECT_EQ(config->run.retries, untouched.run.retries);
  EXPECT_EQ(config->run.seed, untouched.run.seed);
  EXPECT_EQ(config->store.dir, untouched.store.dir);
  EXPECT_EQ(config->store.journal, untouched.store.journal);
  EXPECT_EQ(config->stream.tcp, untouched.stream.tcp);
  EXPECT_EQ(config->stream.unix_path, untouched.stream.unix_path);
  EXPECT_EQ(config->control.unix_path, untouched.control.unix_path);
  EXPECT_EQ(config->control.mode, untouched.control.mode);
  EXPECT_EQ(config->log_level, untouched.log_level);
  EXPECT_EQ(config->speed_up, untouched.speed_up);
}

/// 2^32 + 121 is not 121.
TEST(Config, AWholeNumberThatIsTooLargeIsRefused) {
  const auto config = parse_config("[run]\nrandom = 4294967417\n", "rig.toml");
  ASSERT_FALSE(config);
  EXPECT_THAT(config.error().lines,
              Contains(HasSubstr("rig.toml:2:1: [run]: 'random': 4294967417 is too large")));
}

TEST(Config, ANegativeSeedIsRefused) {
  const auto config = parse_config("[run]\nseed = -1\n", "rig.toml");
  ASSERT_FALSE(config);
  EXPECT_THAT(config.error().lines, Contains(HasSubstr("rig.toml:2:1: [run]: 'seed'")));
}

TEST(Config, AnEmptyFileIsAConfigurationWithoutInstruments) {
  const test::TempDir dir;
  const std::filesystem::path path = dir / "empty.toml";
  std::ofstream{path};
  const auto from_file = load_config(path), from_text = parse_config("", path.string());
  ASSERT_EQ(from_file.has_value(), from_text.has_value());
  if (!from_file) {
    EXPECT_EQ(from_file.error().lines, from_text.error().lines);
  }
}

}  // namespace
}  // namespace mgtd::daemon::config
