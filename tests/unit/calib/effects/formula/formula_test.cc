// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/formula/formula.h"

#include <gmock/gmock.h>

#include <array>

#include "calib/calibration/calibration.h"
#include "calib/criticism/tests/collinearity.h"
#include "calib/effects/derivative_check.h"
#include "calib/effects/formula/angle_unit.h"
#include "calib/effects/formula/expression.h"
#include "calib/effects/library/library.h"
#include "calib/fit/method_choice/fit.h"
#include "calib/report/formula_report.h"
#include "tests/blind/hidden_run.h"

namespace mgtd::calib::effects::formula {
namespace {

using ::testing::HasSubstr;
using testing::hidden_run;
using testing::HiddenRun;

EffectPtr formula(const std::string& spec) {
  auto effect = library::make_effect(spec);
  if (!effect) throw std::runtime_error(effect.error().text());
  return *effect;
}

Error refusal(const std::string& spec) {
  auto effect = library::make_effect(spec);
  return effect ? Error{ErrorCode::internal, "accepted", ""} : effect.error();
}

/// Two effects that a formula can say: an offset with temperature on s3.z, a cubic on s1.x.
PoseTable warm_and_bent(std::uint64_t seed) {
  HiddenRun run;
  run.hidden = [](const Pose& p, int i, int a, const Eigen::Vector3d& v) {
    if (i == 2 && a == 2) return 0.8 * (*p.T_degC[2] - 20);
    return i == 0 && a == 0 ? 6.0 * std::pow(v[0] / 50'000, 3) : 0.0;
  };
  PoseTable table = hidden_run(run, seed);
  for (Pose& pose : table.poses) pose.covariates["lamp_A"] = pose.number % 3;
  return table;
}

fit::FitReport fit_with(const PoseTable& table, const std::vector<std::string>& specs) {
  fit::FitOptions options;
  for (const std::string& s : specs) options.effects.push_back(formula(s));
  auto report = fit::method_choice::fit(table, options);
  if (!report) throw std::runtime_error(report.error().text());
  return std::move(*report);
}

TEST(Formula, ASpecReadsBackAndTheExpressionKeepsItsCommas) {
  const std::string text = "lamp@s3.z,level=axis,unit=nT/A,expr=min(lamp_A, 2)*k";
  EXPECT_EQ(formula(text)->spec(), text);
  EXPECT_EQ(formula(formula("a,tau=2..120,expr=exp(-t_h/tau)")->spec())->spec(),
            "a@each-axis,tau=2..120,expr=exp(-t_h/tau)");
  EXPECT_EQ(formula("a,expr=T_degC")->coefficients().size(), 12U);
  EXPECT_EQ(formula("a@all,expr=k1*T_degC + k2*t_h")->coefficients().size(), 2U);
  EXPECT_EQ(formula("a,level=site,expr=t_h")->coefficients().size(), 3U);
  EXPECT_EQ(formula("a,level=gradient,expr=t_h")->spec(), "a,level=gradient,expr=t_h");
}

TEST(Formula, OfAGradientHasItsFiveComponents) {
  const EffectPtr one = formula("a,level=gradient,expr=t_h");
  ASSERT_EQ(one->coefficients().size(), 5U);
  EXPECT_EQ(one->coefficients()[3].name, "Gxz");
  EXPECT_EQ(one->coefficients()[3].unit, "nT/m");
  const EffectPtr two = formula("a,level=gradient,expr=k1*t_h + k2*t_h^2");
  ASSERT_EQ(two->coefficients().size(), 10U);
  EXPECT_EQ(two->coefficients()[7].name, "Gxz.k2");
  Pose level;
  level.azimuth_rad = level.pitch_rad = level.roll_rad = 0;
  EXPECT_EQ(two->missing(level), "");
  EXPECT_EQ(two->missing({}), "azimuth_deg");
}

/// t_h times a gradient is what the library calls a drift of the gradient; with 1 + t_h it is that and the
/// gradient itself.
TEST(Formula, OfAGradientIsTheTermOfTheLibrary) {
  Pose pose;
  pose.azimuth_rad = pose.pitch_rad = pose.roll_rad = 0;
  const Conditions at{.pose = pose, .t_h = 0.7};
  std::vector<Jet> x{Jet(0.11), Jet(-0.2), Jet(0.05)}, c;
  for (std::size_t i = 0; i < 3; ++i) x[i].d[static_cast<Eigen::Index>(i)] = 1;
  for (const double g : {3.0, -5.0, 7.0, 2.0, -4.0}) {
    c.emplace_back(g);
    c.back().d[static_cast<Eigen::Index>(2 + c.size())] = 1;
  }
  const auto term = [&](const EffectPtr& effect) {
    std::vector<Jet> out(3);
    effect->term(at, 1, std::span<const Jet>(x), std::span<const Jet>(c), std::span<Jet>(out));
    return out;
  };
  const auto drift = term(formula("site.gradient-drift")), gradient = term(formula("site.gradient"));
  const auto same = term(formula("a,level=gradient,expr=t_h"));
  const auto both = term(formula("a,level=gradient,expr=1 + t_h"));
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(same[i].v, drift[i].v, 1e-12);
    EXPECT_LT((same[i].d - drift[i].d).abs().maxCoeff(), 1e-12);
    EXPECT_NEAR(both[i].v, gradient[i].v + drift[i].v, 1e-12);
    EXPECT_LT((both[i].d - gradient[i].d - drift[i].d).abs().maxCoeff(), 1e-12);
  }
}

/// Gxx.k1, Gxx.k2, Gyy.k1 ...: the gradient and its drift, each with coefficients of its own.
TEST(Formula, CoefficientsOfAGradientStandByComponent) {
  Pose pose;
  pose.azimuth_rad = pose.pitch_rad = pose.roll_rad = 0;
  const Conditions at{.pose = pose, .t_h = 0.7};
  const std::array<double, 3> x{0.11, -0.2, 0.05};
  const std::array<double, 5> G{3, -5, 7, 2, -4}, drift{-1, 6, 0.5, -8, 9};
  std::vector<double> both;
  for (std::size_t m = 0; m < G.size(); ++m) both.insert(both.end(), {G[m], drift[m]});
  const auto term = [&](const char* spec, std::span<const double> c) {
    std::array<double, 3> out{};
    formula(spec)->term(at, 1, std::span<const double>(x), c, std::span<double>(out));
    return out;
  };
  const auto of_G = term("site.gradient", G), of_drift = term("site.gradient-drift", drift);
  const auto of_both = term("a,level=gradient,expr=k1 + k2*t_h", both);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(of_both[i], of_G[i] + of_drift[i], 1e-12);
}

/// The same law by the library and by a formula, one through temperature, one through the field itself.
TEST(Formula, WhatTheLibraryKnowsTooGivesTheSameFit) {
  const PoseTable table = warm_and_bent(1);
  const fit::FitReport a = fit_with(table, {"axis.offset.temperature@s3.z", "axis.cubic@s1.x"});
  const fit::FitReport b = fit_with(table, {"warm@s3.z,expr=T_degC-20", "bent@s1.x,expr=(u/50000)^3"});
  EXPECT_NEAR(a.chi2, b.chi2, 1e-5 * a.chi2);
  for (std::size_t e = 0; e < 2; ++e) {
    const calibration::EffectCoefficient &x = a.calibration.effects[e].coefficients[0],
                                         &y = b.calibration.effects[e].coefficients[0];
    EXPECT_NEAR(x.value, y.value, 1e-3 * x.sd) << a.calibration.effects[e].effect;
    EXPECT_NEAR(x.sd, y.sd, 1e-4 * x.sd);
  }
}

TEST(Formula, TheCalibrationIsCompleteInItself) {
  const fit::FitReport fitted =
      fit_with(warm_and_bent(2), {"warm@s3.z,unit=nT/degC,expr=min(k, k)*(T_degC-20)"});
  const auto read = calibration::calibration_from_json_text(calibration::to_json_text(fitted.calibration));
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->effects[0].effect, "warm@s3.z,unit=nT/degC,expr=min(k, k)*(T_degC-20)");
  EXPECT_EQ(read->effects[0].coefficients[0].unit, "nT/degC");
}

TEST(Formula, ANumberInItIsFound) {
  HiddenRun run;
  run.hidden = [](const Pose& p, int i, int a, const Eigen::Vector3d&) {
    return i == 1 && a == 1 ? 20 * std::exp(-*p.t_s / 600) : 0.0;
  };
  const fit::FitReport fitted =
      fit_with(hidden_run(run, 3), {"settling@s2.y,tau=60..6000,expr=k*exp(-t_h*3600/tau)"});
  const auto spec = EffectSpec::parse(fitted.calibration.effects[0].effect);
  ASSERT_TRUE(spec);
  EXPECT_NEAR(spec->number("tau", 0, 0, 1e9).value(), 600, 60);
  EXPECT_NEAR(fitted.calibration.effects[0].coefficients[0].value, 20, 2);
}

TEST(Formula, MistakesAreShownAtTheirColumn) {
  EXPECT_THAT(refusal("a,expr=2*(T_degC").message, HasSubstr("column"));
  EXPECT_THAT(refusal("a,expr=T_degC + * 2").message, HasSubstr("column 10:"));
  EXPECT_THAT(refusal("a,expr=T_degC = 2").message, HasSubstr("column 8: nothing can be assigned"));
  EXPECT_THAT(refusal("a,expr=k*T_degC + 3").message, HasSubstr("does not vanish"));
  EXPECT_THAT(refusal("a,expr=T_degC^k").message, HasSubstr("column 8:"));
  EXPECT_THAT(refusal("a,expr=sin(k*T_degC)").message, HasSubstr("not linear in its coefficients"));
  EXPECT_THAT(refusal("a,expr=sin(k*T_degC)").remedy, HasSubstr("--scan"));
  EXPECT_EQ(refusal("a,expr=nosuch(2)").code, ErrorCode::usage);
  EXPECT_THAT(refusal("a,tau=2..120,expr=T_degC").message, HasSubstr("tau is not in the expression"));
  EXPECT_THAT(refusal("a@s3,level=site,expr=t_h").message, HasSubstr("cannot be laid over 's3'"));
  EXPECT_THAT(refusal("a,level=gradient,expr=t_h*px").message,
              HasSubstr("a gradient is the same at every place"));
  EXPECT_THAT(refusal("a,level=gradient,expr=k1*t_h + k3*t_h^2").message,
              HasSubstr("a gradient takes k, or k1 and k2, and no k3"));
}

TEST(Formula, AColumnThatNoPoseHasIsNamedWithThoseThereAre) {
  const PoseTable table = warm_and_bent(4);
  const auto wrong = check_columns(*EffectSpec::parse("a,expr=2*lampA"), table);
  ASSERT_FALSE(wrong);
  EXPECT_THAT(wrong.error().message, HasSubstr("column 3: no pose has a 'lampA'"));
  EXPECT_THAT(wrong.error().remedy, HasSubstr("lamp_A"));
  EXPECT_TRUE(check_columns(*EffectSpec::parse("a,expr=2*lamp_A"), table));
}

TEST(Formula, ANameOfAnotherLevelIsToldFromAColumn) {
  const PoseTable table = warm_and_bent(4);
  const auto refused = [&](const char* spec) {
    const auto ok = check_columns(*EffectSpec::parse(spec), table);
    return ok ? Error{} : ok.error();
  };
  const Error field = refused("a,level=gradient,expr=t_h*u");
  EXPECT_THAT(field.message, HasSubstr("column 5: 'u' is known at level axis, and a is of level gradient"));
  EXPECT_THAT(field.remedy, HasSubstr("give another level"));
  EXPECT_THAT(refused("a,level=gradient,expr=prev_u").message, HasSubstr("'prev_u' is known at level axis"));
  EXPECT_THAT(refused("a,level=site,expr=T_degC").message, HasSubstr("at level axis or platform"));
  EXPECT_THAT(refused("a,level=gradient,expr=lampA").remedy, HasSubstr("coefficients k, or k1 and k2;"));
  EXPECT_THAT(refused("a,expr=z^4").message, HasSubstr("no pose has a 'z'"));
  EXPECT_THAT(refused("a,expr=z^4").message, ::testing::Not(HasSubstr("did you mean")));
  EXPECT_THAT(refused("a,expr=z^4").remedy, HasSubstr("in reports z stands for uz/50000; columns: "));
  EXPECT_THAT(refused("a,expr=exp(T)").remedy, HasSubstr("in reports T stands for T_degC; "));
  EXPECT_THAT(refused("a,level=site,expr=z^4").remedy, ::testing::Not(HasSubstr("in reports")));
  EXPECT_THAT(refused("a,level=site,expr=gz").message, HasSubstr("'gz' is known at level platform"));
  EXPECT_THAT(refused("a,expr=px").message, HasSubstr("'px' is known at level site, and a is of level axis"));
  EXPECT_THAT(refused("a,expr=lag600_lampA").message, HasSubstr("no pose has a 'lag600_lampA'"));
  EXPECT_THAT(refused("a,level=gradient,expr=s1_x_nT").message, HasSubstr("a acts on every sensor"));
}

TEST(Formula, ATemperatureIsOfferedOnlyWhereThereIsOne) {
  PoseTable table = warm_and_bent(4);
  const auto spec = *EffectSpec::parse("a,expr=lampA");
  EXPECT_THAT(check_columns(spec, table).error().remedy, HasSubstr("T_degC, u, ux"));
  for (Pose& pose : table.poses)
    for (auto& T : pose.T_degC) T.reset();
  EXPECT_THAT(check_columns(spec, table).error().remedy, ::testing::Not(HasSubstr("T_degC")));
}

TEST(Formula, TakesEveryColumnThatAPoseHasAndWhatASensorReadBefore) {
  PoseTable table = warm_and_bent(4);
  for (const char* spec :
       {"a@s1.x,expr=s2_x_nT", "a@s1.x,expr=prev_s1_x_nT", "a,level=site,expr=prev_s1_x_nT",
        "a@s1.x,expr=f_sd_nT", "a,expr=f_nT", "a,expr=prev_u", "a,expr=prev_T_degC"}) {
    const auto ok = check_columns(*EffectSpec::parse(spec), table);
    EXPECT_TRUE(ok) << spec << ": " << ok.error().text();
  }
  EXPECT_THAT(check_columns(*EffectSpec::parse("a@s1.x,expr=s1_x_nT"), table).error().message,
              HasSubstr("a acts on s1, whose reading it is to explain"));
  EXPECT_THAT(check_columns(*EffectSpec::parse("a,expr=ref_x_nT"), table).error().message,
              HasSubstr("no pose has a 'ref_x_nT'"));
  for (Pose& pose : table.poses) pose.ref_nT = Eigen::Vector3d(1, 2, 3);
  EXPECT_TRUE(check_columns(*EffectSpec::parse("a,expr=ref_x_nT"), table));
}

TEST(Formula, DegreesHaveFunctionsOfTheirOwn) {
  EXPECT_NEAR((*Expression::parse("sind(30) + cosd(60) + tand(45)"))({}), 2.0, 1e-12);
}

TEST(Formula, AnAngleColumnInAFunctionOfRadiansIsAskedAbout) {
  const auto asked = check_angles("k1*t_h + k2*sin( 3*azimuth_deg)");
  ASSERT_FALSE(asked);
  EXPECT_THAT(asked.error().message,
              HasSubstr("column 13: azimuth_deg is in degrees, and sin takes radians"));
  EXPECT_THAT(asked.error().remedy, HasSubstr("sind( 3*azimuth_deg)"));
  EXPECT_FALSE(check_angles("exp(cos((pitch_deg + 10)*2))"));
  EXPECT_FALSE(check_angles("sind(azimuth_deg) + tan(stage_deg)"));
  for (const char* fine : {"sind(3*azimuth_deg)", "sin(azimuth_deg*pi/180)", "cos(0.0174533*azimuth_deg)",
                           "sin(azimuth_deg/57.29578)", "sin(T_degC)", "asin(azimuth_deg/360)",
                           "azimuth_deg*sin(t_h)", "sin(2*pi*t_h)*cosd(roll_deg)"})
    EXPECT_TRUE(check_angles(fine)) << fine;
}

/// As `mgt define` does: what a formula looks back at is of the run.
TEST(Formula, ThatLooksBackIsExaminedOnItsRun) {
  const auto x = criticism::tests::examine_formula(warm_and_bent(6), {},
                                                   *EffectSpec::parse("a@s3.z,expr=lag600_T_degC"));
  ASSERT_TRUE(x) << x.error().text();
  EXPECT_LT(x->log10_p, -10) << "the offset follows the temperature, and so nearly its low-pass";
  EXPECT_FALSE(x->wholly_absorbed());
}

/// A gradient may follow what a column was before; what a sensor read before is none of the site's.
TEST(Formula, OfAGradientLooksBackAtColumns) {
  PoseTable table = warm_and_bent(6);
  for (Pose& pose : table.poses) pose.covariates["lift_m"] = pose.number % 5;
  const auto bound =
      formula("a,level=gradient,expr=lag600_lift_m")->bound({.table = &table, .offset_nT = {}});
  ASSERT_TRUE(bound) << bound.error().text();
  ASSERT_TRUE(*bound);
  EXPECT_EQ((*bound)->missing(table.poses[3]), "");
  EXPECT_EQ(formula("a,level=gradient,expr=prev_ux")->missing(table.poses[3]), "prev_ux") << "a column";
}

TEST(Formula, ARowWithoutItsColumnIsNotFed) {
  Pose pose;
  EXPECT_EQ(formula("a,expr=lamp_A")->missing(pose), "lamp_A");
  EXPECT_EQ(formula("a@s3,expr=T_degC")->missing(pose), "s3_T_degC");
  pose.covariates["lamp_A"] = 0;
  EXPECT_EQ(formula("a,expr=lamp_A")->missing(pose), "");
}

TEST(FormulaDerivatives, SmoothOnesPassAndJumpsAreRefused) {
  const PoseTable table = warm_and_bent(5);
  for (const char* smooth :
       {"a,expr=u^3/1e9", "a,expr=ux*uy/1e5*sin(t_h)", "a,level=platform,expr=b*gz", "a,expr=tanh(u/2000)",
        "a,level=site,expr=px^2 + py", "a,level=gradient,expr=k1*sin(t_h) + k2*cos(t_h)"}) {
    const auto ok = check_derivatives(*formula(smooth), table);
    EXPECT_TRUE(ok) << smooth << ": " << ok.error().text();
  }
  const auto jump = check_derivatives(*formula("a,expr=sign(u)"), table);
  ASSERT_FALSE(jump);
  EXPECT_THAT(jump.error().remedy, HasSubstr("tanh"));
}

/// A law whose derivative by its own reading is a tenth too large.
class Planted final : public Effect {
 public:
  [[nodiscard]] std::string_view name() const override { return "planted"; }
  [[nodiscard]] Level level() const override { return Level::axis; }
  [[nodiscard]] const std::vector<Coefficient>& coefficients() const override { return coefficients_; }
  [[nodiscard]] std::span<const int> at(int) const override { return at_; }
  [[nodiscard]] std::string_view missing(const Pose&) const override { return {}; }
  void term(const Conditions&, int, std::span<const double> in, std::span<const double> c,
            std::span<double> out) const override {
    for (std::size_t a = 0; a < 3; ++a) out[a] = c[0] * in[a] * in[a];
  }
  void term(const Conditions&, int, std::span<const Jet> in, std::span<const Jet> c,
            std::span<Jet> out) const override {
    for (std::size_t a = 0; a < 3; ++a) {
      out[a] = c[0] * in[a] * in[a];
      out[a].d += 0.1 * 2 * c[0].v * in[a].v * in[a].d;
    }
  }

 private:
  std::vector<Coefficient> coefficients_{{.name = "all", .unit = "nT"}};
  std::vector<int> at_{0};
};

TEST(FormulaDerivatives, AWrongOneIsCaught) {
  const auto caught = check_derivatives(Planted{}, warm_and_bent(6));
  ASSERT_FALSE(caught);
  EXPECT_THAT(caught.error().message, HasSubstr("does not change smoothly"));
}

TEST(FormulaExamination, WhatTheCalibrationHoldsAlreadyIsSaid) {
  const PoseTable table = warm_and_bent(7);
  for (const char* absorbed :
       {"offset@s2.x,expr=1", "scale@s2.x,expr=u/1000", "iron@s2,level=platform,expr=b/1000"}) {
    const auto x = criticism::tests::examine_formula(table, {}, *EffectSpec::parse(absorbed));
    ASSERT_TRUE(x) << x.error().text();
    EXPECT_TRUE(x->wholly_absorbed()) << absorbed << ": " << x->absorbed;
    EXPECT_GT(x->absorbed, 0.999999) << absorbed;
    EXPECT_THAT(report::to_text(*x), HasSubstr("absorbs it whole"));
  }
}

TEST(FormulaExamination, TheEffectItResemblesIsNamed) {
  const PoseTable table = warm_and_bent(8);
  const auto x =
      criticism::tests::examine_formula(table, {}, *EffectSpec::parse("warm@s3.z,expr=2*T_degC + 0*lamp_A"));
  ASSERT_TRUE(x) << x.error().text();
  ASSERT_FALSE(x->alike.empty());
  EXPECT_EQ(x->alike[0].effect, "axis.offset.temperature");
  EXPECT_GT(x->alike[0].correlation, 0.9999);
  EXPECT_GT(x->d(), 10) << "it is there";
  EXPECT_GT(x->absorbed, 0.5) << "its mean is an offset";
  const auto lamp = criticism::tests::examine_formula(table, {}, *EffectSpec::parse("lamp@s3.z,expr=lamp_A"));
  ASSERT_TRUE(lamp);
  EXPECT_LT(lamp->d(), 4.5) << "it is not there";
  ASSERT_FALSE(lamp->alike.empty());
  EXPECT_EQ(lamp->alike[0].effect, "platform.current") << "a column in ampere is one of its own";
}

}  // namespace
}  // namespace mgtd::calib::effects::formula
