// SPDX-License-Identifier: Apache-2.0
#include "drivers/obsdaq_settings.h"

#include <gmock/gmock.h>

namespace mgtd::drivers::obsdaq {
namespace {

using ::testing::HasSubstr;

struct Entry {
  const char* key;
  Settings::Value value;
};

/// The messages a section provokes; line numbers count from 2.
std::vector<SettingError> mistakes(std::vector<Entry> entries, ObsdaqSettings* out = nullptr) {
  Settings settings("[[sensor]] s1", 1);
  int line = 2;
  for (auto& [key, value] : entries) settings.set(key, std::move(value), line++);
  ObsdaqSettings read = read_obsdaq_settings(settings);
  if (out != nullptr) *out = read;
  return settings.errors();
}

const Entry kProfile{"profile", std::string("mag-13-100")};

TEST(ObsdaqSettings, ProfilesGiveTheScale) {
  for (const auto& [name, nT_per_V] : {std::pair{"mag-03-70", 7000.0},
                                       {"mag-03-100", 10000.0},
                                       {"mag-13-250", 25000.0},
                                       {"mag-13-1000", 100000.0}}) {
    ObsdaqSettings settings;
    EXPECT_TRUE(mistakes({{"profile", std::string(name)}}, &settings).empty());
    EXPECT_EQ(settings.scale_nT_per_V, Eigen::Vector3d::Constant(nT_per_V));
  }
}

TEST(ObsdaqSettings, OwnScaleAndOffset) {
  ObsdaqSettings settings;
  EXPECT_TRUE(mistakes({{"scale_nT_per_V", std::vector<double>{1, 2, 3}},
                        {"offset_nT", std::vector<double>{4, 5, 6}},
                        {"range_V", 2.5}},
                       &settings)
                  .empty());
  EXPECT_EQ(settings.scale_nT_per_V, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(settings.offset_nT, Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(settings.range.code, "04");
}

TEST(ObsdaqSettings, MistakesNameTheRemedyAndTheLine) {
  const auto one = [](std::vector<Entry> entries) {
    const auto errors = mistakes(std::move(entries));
    EXPECT_EQ(errors.size(), 1U);
    return errors.empty() ? SettingError{} : errors[0];
  };
  EXPECT_THAT(one({}).message, HasSubstr("scale_nT_per_V = [x, y, z]"));
  EXPECT_THAT(one({kProfile, {"scale_nT_per_V", std::vector<double>{1, 2, 3}}}).message,
              HasSubstr("one of both"));
  EXPECT_THAT(one({{"profile", std::string("mag-12-100")}}).message, HasSubstr("70, 100, 250, 500, 1000"));
  EXPECT_THAT(one({{"scale_nT_per_V", std::vector<double>{1, 0, 3}}}).message, HasSubstr("zero"));
  EXPECT_THAT(one({kProfile, {"range_V", 3.0}}).message, HasSubstr("10, 5 or 2.5"));
  EXPECT_EQ(one({kProfile, {"range_V", 3.0}}).line, 3);
  EXPECT_THAT(one({kProfile, {"address", std::string("1")}}).message, HasSubstr("two hex digits"));
  EXPECT_THAT(one({kProfile, {"baud", std::int64_t{-1}}}).message, HasSubstr("line speed"));
  EXPECT_THAT(one({kProfile, {"temperature", std::string("s")}}).message, HasSubstr("\"p\", \"q\", \"r\""));
  EXPECT_THAT(one({kProfile, {"temperature", std::string("q")}}).message, HasSubstr("degC_per_V"));
  EXPECT_THAT(one({kProfile, {"rate_hz", 1.0}}).message, HasSubstr("2.35 Hz"));
  EXPECT_THAT(one({kProfile, {"rate_hz", 1.0}}).line, 3);
}

TEST(ObsdaqSettings, AnInputIsAColumnWithItsUnitAndScale) {
  ObsdaqSettings settings;
  EXPECT_TRUE(mistakes({kProfile,
                        {"inputs.q.name", std::string("motor_A")},
                        {"inputs.q.unit", std::string("A")},
                        {"inputs.q.scale", 2.0},
                        {"inputs.q.offset", -0.1},
                        {"inputs.r.name", std::string("supply_V")},
                        {"inputs.r.unit", std::string("V")},
                        {"temperature", std::string("p")},
                        {"degC_per_V", 10.0}},
                       &settings)
                  .empty());
  ASSERT_EQ(settings.inputs.size(), 3U);
  EXPECT_EQ(settings.inputs[0].column, "s1_T_degC");
  EXPECT_EQ(settings.inputs[0].index, 0U);
  EXPECT_EQ(settings.inputs[1].column, "motor_A");
  EXPECT_EQ(settings.inputs[1].index, 1U);
  EXPECT_EQ(settings.inputs[1].unit, "A");
  EXPECT_EQ(settings.inputs[1].scale, 2.0);
  EXPECT_EQ(settings.inputs[1].offset, -0.1);
  EXPECT_EQ(settings.inputs[2].scale, 1.0) << "a voltage in volts needs none";
}

TEST(ObsdaqSettings, AnInputThatIsNotStatedWellIsRefusedAtItsPlace) {
  const Entry name{"inputs.q.name", std::string("motor_A")}, unit{"inputs.q.unit", std::string("A")},
      scale{"inputs.q.scale", 2.0};
  const auto one = [&](std::vector<Entry> entries, int line, const char* what) {
    entries.insert(entries.begin(), kProfile);  // line 2
    const auto errors = mistakes(std::move(entries));
    ASSERT_EQ(errors.size(), 1U) << what;
    EXPECT_EQ(errors[0].line, line) << errors[0].message;
    EXPECT_THAT(errors[0].message, HasSubstr(what));
  };
  one({unit, scale}, 4, "needs a name");  // the keys of a table are in alphabetical order: its scale is first
  one({name, scale}, 3, "needs a unit beside it");
  one({name, unit}, 3, "needs a scale beside it, A per V");
  one({name, unit, {"inputs.q.scale", 0.0}}, 5, "other than 0");
  one({{"inputs.q.name", std::string("motor A")}, unit, scale}, 3, "no column's name");
  one({{"inputs.q.name", std::string("motor_V")}, unit, scale}, 3,
      "the end of 'motor_V' says V, the unit is A");
  one({{"inputs.s.name", std::string("motor_A")}}, 3, "there is no 's': an ObsDAQ has the inputs p, q and r");
  one({name, unit, scale, {"temperature", std::string("q")}, {"degC_per_V", 1.0}}, 6,
      "leave one of the two out");
}

TEST(ObsdaqSettings, ARateTheLineCannotCarryIsRefusedWithTheHighestThatFits) {
  EXPECT_TRUE(mistakes({kProfile, {"rate_hz", 50.0}}).empty());
  EXPECT_TRUE(mistakes({kProfile, {"rate_hz", 90.0}}).empty());
  const auto direct = mistakes({kProfile, {"rate_hz", 100.0}});
  ASSERT_EQ(direct.size(), 1U);
  EXPECT_THAT(direct[0].message, HasSubstr("highest rate that fits is 90.4 Hz"));
  EXPECT_TRUE(mistakes({kProfile, {"rate_hz", 100.0}, {"baud", std::int64_t{38400}}}).empty());
}

TEST(ObsdaqSettings, BehindAPalmAcqBothLinesMustCarryTheRate) {
  const Entry palmacq{"palmacq", true};
  EXPECT_TRUE(mistakes({kProfile, palmacq, {"rate_hz", 50.0}}).empty());
  EXPECT_THAT(mistakes({kProfile, palmacq, {"rate_hz", 100.0}}).at(0).message,
              HasSubstr("between ObsDAQ and PalmAcq"));
  EXPECT_THAT(mistakes({kProfile, palmacq, {"rate_hz", 50.0}, {"baud", std::int64_t{19200}}}).at(0).message,
              HasSubstr("45 bytes a sample"));
}

}  // namespace
}  // namespace mgtd::drivers::obsdaq
