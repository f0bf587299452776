// SPDX-License-Identifier: Apache-2.0
#include "calib/report/run_figures.h"

#include <gmock/gmock.h>

#include <set>

#include "calib/report/panel_figures.h"
#include "tests/blind/hidden_run.h"

namespace mgtd::calib::report {
namespace {

using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using ::testing::Not;

struct Seen {
  PoseTable table;
  criticism::tests::Comparison comparison;
  criticism::tests::ResidualColumns left;
};

/// On the heap: fits point to the poses.
std::unique_ptr<Seen> seen(PoseTable table) {
  auto out = std::make_unique<Seen>();
  out->table = std::move(table);
  auto compared = criticism::tests::compare(out->table, {});
  EXPECT_TRUE(compared);
  out->comparison = std::move(*compared);
  auto left = criticism::tests::residual_columns(*out->comparison.fit);
  EXPECT_TRUE(left);
  out->left = std::move(*left);
  return out;
}

PoseTable warming() {
  return testing::hidden_run(
      {.noise_nT = 0.05,
       .hidden = [](const Pose& p, int i, int a,
                    const Eigen::Vector3d&) { return i == 2 && a == 2 ? 0.5 * (*p.T_degC[2] - 20) : 0.0; }},
      5);
}

const figures::Figure& named(const std::vector<figures::Figure>& all, const std::string& name) {
  for (const figures::Figure& f : all)
    if (f.name == name) return f;
  ADD_FAILURE() << "no figure " << name;
  return all.front();
}

TEST(Panels, AreNineAndTellWhatTheResidualFollows) {
  const auto run = seen(warming());
  const std::vector<figures::Figure> all = panel_figures({run->comparison, run->left}, nullptr);
  std::set<std::string> names;
  for (const figures::Figure& f : all) EXPECT_TRUE(names.insert(f.name).second) << f.name << " twice";
  EXPECT_THAT(names,
              IsSupersetOf({"residual-time", "residual-azimuth", "residual-temperature", "skies", "qq",
                            "autocorrelation", "residual-scalar", "residual-attitude", "residual-closure"}));
  const figures::Figure& temperature = named(all, "residual-temperature");
  EXPECT_TRUE(temperature.stands_out);
  EXPECT_THAT(temperature.caption, HasSubstr("s3.z"));
  EXPECT_THAT(temperature.title, HasSubstr("s3"));
  EXPECT_TRUE(named(all, "qq").stands_out);
  EXPECT_FALSE(named(all, "residual-attitude").stands_out);
}

TEST(Panels, OfACleanRunDoNotStandOut) {
  const auto run = seen(testing::hidden_run({}, 6));
  for (const figures::Figure& f : panel_figures({run->comparison, run->left}, nullptr))
    EXPECT_FALSE(f.stands_out) << f.name;
  const auto closure = closure_figure({run->comparison, run->left});
  ASSERT_TRUE(closure);
  EXPECT_FALSE(closure->stands_out);
  EXPECT_FALSE(coverage_of({run->comparison, run->left}).stands_out);
}

TEST(TimeFigure, TellsThatClosureLeavesItsLimit) {
  const auto run = seen(warming());
  const auto closure = closure_figure({run->comparison, run->left});
  ASSERT_TRUE(closure);
  EXPECT_TRUE(closure->stands_out);
  EXPECT_THAT(closure->good, HasSubstr("of 157"));
  EXPECT_THAT(time_figure({run->comparison, run->left}).svg, HasSubstr("temperature"));
}

TEST(TimeFigure, APauseIsAGap) {
  PoseTable table = testing::hidden_run({}, 6);
  for (std::size_t k = 80; k < table.poses.size(); ++k) *table.poses[k].t_s += 3600;
  const auto run = seen(std::move(table));
  const figures::Figure f = time_figure({run->comparison, run->left});
  EXPECT_THAT(f.caption, HasSubstr("no pose"));
  EXPECT_THAT(f.svg, HasSubstr("hatch"));
}

TEST(Accuracy, GrowsPoseByPoseAndEndsAtTheWholeRun) {
  const PoseTable table = testing::hidden_run({}, 6);
  const auto f = accuracy_of(table, {}, 0.001);
  ASSERT_TRUE(f);
  EXPECT_THAT(f->good, HasSubstr("after 157 poses"));
  EXPECT_TRUE(f->stands_out);
  EXPECT_GE(f->data.rows.size(), 4U);
}

}  // namespace
}  // namespace mgtd::calib::report
