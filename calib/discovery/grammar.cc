// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/grammar.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calib/discovery/scalars.h"
#include "calib/effects/effect_context.h"
#include "proto/sha256.h"

namespace mgtd::calib::discovery {
namespace {

constexpr double kField_nT = effects::kReferenceField_nT;
constexpr int kHarmonics = 6, kGainHarmonics = 3;
constexpr Eigen::Index kMostPeriods = 400;

/// From `first` to `last` in equal ratios.
std::vector<double> ratios(double first, double last, int n) {
  std::vector<double> out;
  for (int i = 0; i < n; ++i) out.push_back(first * std::pow(last / first, i / (n - 1.0)));
  return out;
}

/// What stands in a product: about its mean, or about its zero.
struct Factor {
  std::string about_mean, about_zero, covariate;
  int symbols{1}, foreign_sensor{-1};
  bool common{true};
};

class Writer {
 public:
  explicit Writer(const LawInputs& inputs) : inputs_(inputs), scalars_(scalars_of(inputs)) {}

  Grammar write() {
    for (const Scalar& s : scalars_.all) curves(s);
    time();
    for (const Scalar& s : scalars_.all)
      if (s.covariate.ends_with("T_degC")) heat(s);
    for (const std::string& angle : scalars_.angles) harmonics(angle);
    gravity();
    readings();
    before();
    products();
    gains();
    neighbours();
    return std::move(out_);
  }

 private:
  Family& add(Family family) {
    out_.families.push_back(std::move(family));
    return out_.families.back();
  }
  Family& add(std::vector<std::string> covariates, int symbols, const Columns& columns) {
    return add({.covariates = std::move(covariates), .symbols = symbols, .columns = [columns](double) {
                  return columns;
                }});
  }
  Family& on(const Scalar& s, int more_symbols, const Columns& columns) {
    return bound(add({s.covariate}, s.symbols + more_symbols, columns), s);
  }
  Family& on(const Scalar& s, int more_symbols, std::vector<double> inner, std::string unit,
             std::function<Columns(double)> columns) {
    return bound(add({.covariates = {s.covariate},
                      .symbols = s.symbols + more_symbols,
                      .inner = std::move(inner),
                      .inner_unit = std::move(unit),
                      .columns = std::move(columns),
                      .refined = true}),
                 s);
  }
  static Family& bound(Family& family, const Scalar& s) {
    family.foreign_sensor = s.foreign_sensor;
    family.common = s.common;
    return family;
  }

  void curves(const Scalar& s) {
    on(s, 0, {s.text});
    if (!s.curve) return;
    const std::string u = s.about(s.mean);
    on(s, 1, {u + "^2"});
    on(s, 2, {u + "^3"});
    on(s, 2, {u + "^4"});
    on(s, 1, {fmt::format("abs({})", u)});
    on(s, 2, {u, u + "^2"});
    if (s.deciles.empty()) return;
    on(s, 2, s.deciles, "",
       [t = s.text](double c) { return Columns{fmt::format("({}>{})", t, number_text(c))}; });
    on(s, 2, s.deciles, "", [s](double c) { return Columns{fmt::format("max(0, {})", s.about(c))}; });
    on(s, 2, s.deciles, "",
       [t = s.text](double c) { return Columns{fmt::format("max(0, {}-{})", number_text(c), t)}; });
  }

  [[nodiscard]] std::vector<double> periods_h() const {
    const Eigen::VectorXd t = inputs_.name("t_h", 0);
    const double length_h = t.maxCoeff() - t.minCoeff();
    std::vector<double> out;
    if (!(length_h > 0)) return out;
    for (Eigen::Index j = std::min(t.size(), kMostPeriods); j > 0; --j)
      out.push_back(2 * length_h / static_cast<double>(j));
    return out;
  }
  static std::string decay(double tau_s) { return fmt::format("exp(-3600*t_h/{})", number_text(tau_s)); }
  static Columns period(double hours, const std::string& times) {
    const std::string angle = fmt::format("(2*pi*t_h/{})", number_text(hours));
    return {times + "sin" + angle, times + "cos" + angle};
  }

  void time() {
    const Scalar* t = scalars_.find("t_h");
    if (t == nullptr) return;
    on(*t, 1, {"sqrt(max(t_h, 0))"});
    on(*t, 2, kDecays_s, "s", [](double tau) { return Columns{decay(tau)}; });
    on(*t, 3, periods_h(), "h", [](double hours) { return period(hours, ""); }).whole_array = false;
  }

  static std::string lag(double tau_s, const std::string& of) {
    return fmt::format("lag{}_{}", std::max(1L, std::lround(tau_s)), of);
  }
  void heat(const Scalar& T) {
    if (scalars_.find("t_h") == nullptr) return;
    const std::string rate = "rate_" + T.covariate;
    on(T, 2, kLags_s, "s", [of = T.covariate](double tau) { return Columns{lag(tau, of)}; });
    on(T, 1, {rate});
    on(T, 3, {T.about(T.mean), rate});
  }

  void harmonics(const std::string& angle) {
    for (int n = 1; n <= kHarmonics; ++n) {
      const std::string sin = fmt::format("sind({}*{})", n, angle),
                        cos = fmt::format("cosd({}*{})", n, angle);
      for (const Columns& columns : {Columns{sin}, Columns{cos}, Columns{sin, cos}}) add({angle}, 3, columns);
    }
    if (angle != "azimuth_deg") add({angle}, 3, {fmt::format("abs(sind({}))", angle)});
  }
  void gravity() {
    if (scalars_.angles.size() < 3) return;
    const Columns g{kGravity.begin(), kGravity.end()};
    for (const std::string& component : g) add({"gravity"}, 3, {component});
    add({"gravity"}, 4, {g[0], g[1]});
    add({"gravity"}, 4, g);
  }

  Family& of_reading(const std::string& name, int symbols, const Columns& columns) {
    return placed(add({name}, symbols, columns), name);
  }
  Family& of_reading(const std::string& name, int symbols, std::vector<double> inner,
                     std::function<Columns(double)> columns) {
    return placed(add({.covariates = {name},
                       .symbols = symbols,
                       .inner = std::move(inner),
                       .columns = std::move(columns),
                       .refined = true}),
                  name);
  }
  static Family& placed(Family& family, const std::string& name) {
    family.common = false;
    for (int axis = 0; axis < 3; ++axis)
      if (name == kAxes[static_cast<std::size_t>(axis)] ||
          name == "prev_" + kAxes[static_cast<std::size_t>(axis)])
        family.foreign_axis = axis;
    return family;
  }
  static std::string over_field(const std::string& name) {
    return fmt::format("({}/{})", name, number_text(kField_nT));
  }
  [[nodiscard]] std::vector<double> knots() const {
    double most = 0;
    for (int c = 0; c < inputs_.channels(); ++c)
      most = std::max(most, inputs_.name("u", c).cwiseAbs().maxCoeff() / kField_nT);
    std::vector<double> out;
    for (const double share : {-0.7, -0.5, -0.3, -0.1, 0.1, 0.3, 0.5, 0.7}) out.push_back(share * most);
    return out;
  }
  void readings() {
    const std::vector<double> at = knots();
    const std::vector<double> sizes(at.begin() + 4, at.end());
    for (const std::string& name : kReadings) {
      const std::string x = over_field(name);
      for (int power = 2; power <= (name == "u" ? 6 : 4); ++power)
        of_reading(name, power < 4 ? 2 : power == 4 ? 3 : 4, {fmt::format("{}^{}", x, power)});
      of_reading(name, 2, {fmt::format("abs({})", x)});
      of_reading(name, 2, {fmt::format("sign({})", x)});
      of_reading(name, 3, {fmt::format("{}*abs({})", x, x)});
      if (name != "u") continue;
      of_reading(name, 3, ratios(0.03, 0.6, 8),
                 [x](double w) { return Columns{fmt::format("tanh({}/{})", x, number_text(w))}; });
      of_reading(name, 3, at, [x](double c) { return Columns{fmt::format("max(0, {})", less_text(x, c))}; });
      of_reading(name, 3, at, [x](double c) { return Columns{fmt::format("({}>{})", x, number_text(c))}; });
      of_reading(name, 4, sizes,
                 [x](double c) { return Columns{fmt::format("max(0, abs({})-{})", x, number_text(c))}; });
    }
    for (std::size_t a = 0; a < 3; ++a) {
      const std::string xa = over_field(kAxes[a]);
      for (std::size_t b = 0; b < 3; ++b) {
        if (b == a) continue;
        const std::string xb = over_field(kAxes[b]);
        if (b > a) shared({kAxes[a], kAxes[b]}, 3, {xa + "*" + xb});
        shared({kAxes[a], kAxes[b]}, 4, {xa + "^2*" + xb});
      }
    }
    shared({kAxes[0], kAxes[1], kAxes[2]}, 5,
           {fmt::format("{}*{}*{}", over_field("ux"), over_field("uy"), over_field("uz"))});
  }
  /// Of several axes of a sensor: the same on each of them.
  void shared(std::vector<std::string> covariates, int symbols, const Columns& columns) {
    add(std::move(covariates), symbols, columns).common = false;
  }

  void before() {
    for (const std::string& own : kReadings) {
      const std::string name = "prev_" + own, x = over_field(name);
      of_reading(name, 2, {x});
      of_reading(name, 3, {fmt::format("abs({})", x)});
      of_reading(name, 3, {x + "^2"});
      of_reading(name, 3, {fmt::format("sign({})", x)});
    }
    of_reading("prev_u", 4, {fmt::format("{}*{}", over_field("prev_u"), over_field("u"))});
    of_reading("prev_u", 4, {fmt::format("abs(prev_u-u)/{}", number_text(kField_nT))});
  }

  [[nodiscard]] static Factor factor(const Scalar& s) {
    return {s.about(s.mean), s.about(s.zero), s.covariate, s.symbols, s.foreign_sensor, s.common};
  }
  Family& product(const Factor& a, const Factor& b, int symbols) {
    std::vector<std::string> covariates{a.covariate};
    if (b.covariate != a.covariate) covariates.push_back(b.covariate);
    Columns forms;
    for (const std::string& of_a : {a.about_mean, a.about_zero}) {
      for (const std::string& of_b : {b.about_mean, b.about_zero}) {
        const std::string form = of_a + "*" + of_b;
        if (std::find(forms.begin(), forms.end(), form) == forms.end()) forms.push_back(form);
      }
    }
    std::vector<double> which;
    for (std::size_t i = 0; i < forms.size(); ++i) which.push_back(static_cast<double>(i));
    Family& out = add({.covariates = std::move(covariates),
                       .symbols = symbols,
                       .inner = which,
                       .columns = [forms](double i) { return Columns{forms[static_cast<std::size_t>(i)]}; }});
    out.foreign_sensor = std::max(a.foreign_sensor, b.foreign_sensor);
    out.common = a.common && b.common;
    return out;
  }
  void products() {
    std::vector<Factor> factors;
    for (const Scalar& s : scalars_.all)
      if (s.covariate != "azimuth_deg" && s.covariate != "roll_deg") factors.push_back(factor(s));
    if (scalars_.all.empty()) return;
    const std::string parity = "cos(pi*pose)";
    add({"pose"}, 1, {parity});
    factors.push_back({parity, parity, "pose"});
    for (const std::string& angle : scalars_.angles)
      for (const char* of : {"sind", "cosd"})
        factors.push_back({fmt::format("{}({})", of, angle), fmt::format("{}({})", of, angle), angle, 2});
    for (std::size_t i = 0; i < factors.size(); ++i)
      for (std::size_t j = i + 1; j < factors.size(); ++j)
        product(factors[i], factors[j], factors[i].symbols + factors[j].symbols + 1);
    const Scalar* t = scalars_.find("t_h");
    if (t == nullptr) return;
    for (const Scalar& T : scalars_.all) {
      if (!T.covariate.ends_with("T_degC")) continue;
      const Factor time = factor(*t), heat = factor(T);
      const auto squared = [](const Factor& f) {
        Factor out = f;
        out.about_mean += "^2", out.about_zero += "^2";
        return out;
      };
      product(squared(heat), time, T.symbols + 3);
      product(heat, squared(time), T.symbols + 3);
      on(T, 4, kLags_s, "s", [T](double tau) {
        return Columns{fmt::format("({})*t_h", less_text(lag(tau, T.covariate), T.mean))};
      }).covariates.emplace_back("t_h");
    }
  }

  /// A law of the gain of this reading.
  Family& gain(const std::string& reading, Family family) {
    family.covariates.insert(family.covariates.begin(), reading);
    return placed(add(std::move(family)), reading);
  }
  void gains() {
    const Factor x{over_field("u"), over_field("u"), "u", 1, -1, false};
    for (const Scalar& s : scalars_.all) {
      const bool recorded = !s.covariate.ends_with("_deg");
      if (!recorded) continue;
      product(x, factor(s), s.symbols + 2);
      if (!s.curve) continue;
      Factor square = factor(s);
      square.about_mean += "^2", square.about_zero = square.about_mean;
      product(x, square, s.symbols + 3);
      if (s.foreign_sensor >= 0) continue;
      for (const std::string& axis : kAxes) {
        const Factor other{over_field(axis), over_field(axis), axis, 1, -1, false};
        placed(product(other, factor(s), s.symbols + 3), axis);
      }
      const std::string size = fmt::format("abs({})", over_field("u")), x2 = over_field("u") + "^2";
      for (const std::string& of : {size, x2}) product({of, of, "u", 2, -1, false}, factor(s), s.symbols + 3);
      if (s.deciles.empty()) continue;
      const std::string u = over_field("u") + "*";
      gain("u", {.covariates = {s.covariate},
                 .symbols = s.symbols + 4,
                 .inner = s.deciles,
                 .columns = [u, s](double c) { return Columns{fmt::format("{}max(0, {})", u, s.about(c))}; },
                 .refined = true});
      gain("u",
           {.covariates = {s.covariate},
            .symbols = s.symbols + 4,
            .inner = s.deciles,
            .columns = [u,
                        s](double c) { return Columns{fmt::format("{}({}>{})", u, s.text, number_text(c))}; },
            .refined = true});
    }
    product(x, {"cos(pi*pose)", "cos(pi*pose)", "pose"}, 3);
    gains_of_time_and_heat();
    const std::string u = over_field("u") + "*";
    for (const std::string& angle : scalars_.angles) {
      for (int n = 1; n <= kGainHarmonics; ++n) {
        const std::string sin = fmt::format("{}sind({}*{})", u, n, angle),
                          cos = fmt::format("{}cosd({}*{})", u, n, angle);
        for (const Columns& columns : {Columns{sin}, Columns{cos}, Columns{sin, cos}})
          placed(add({"u", angle}, 5, columns), "u");
      }
    }
  }
  void gains_of_time_and_heat() {
    if (scalars_.find("t_h") == nullptr) return;
    const std::string u = over_field("u") + "*";
    if (const Scalar* T = scalars_.find("T_degC")) {
      placed(add({"u", "T_degC"}, 4, {u + "rate_T_degC"}), "u");
      gain("u", {.covariates = {"T_degC"},
                 .symbols = 5,
                 .inner = kLags_s,
                 .inner_unit = "s",
                 .columns =
                     [u, T = *T](double tau) {
                       return Columns{fmt::format("{}({})", u, less_text(lag(tau, T.covariate), T.mean))};
                     },
                 .refined = true});
    }
    gain("u", {.covariates = {"t_h"},
               .symbols = 5,
               .inner = kDecays_s,
               .inner_unit = "s",
               .columns = [u](double tau) { return Columns{u + decay(tau)}; },
               .refined = true});
    gain("u", {.covariates = {"t_h"},
               .symbols = 6,
               .inner = periods_h(),
               .inner_unit = "h",
               .columns = [u](double hours) { return period(hours, u); },
               .whole_array = false,
               .refined = true});
  }

  void neighbours() {
    for (int s = 0; s < inputs_.channels() / 3 && inputs_.channels() > 3; ++s) {
      for (int axis = 0; axis < 3; ++axis) {
        const int channel = 3 * s + axis;
        const std::string name = fmt::format("s{}_{}_nT", s + 1, "xyz"[axis]);
        const double offset_nT = inputs_.name(name, channel)[0] - inputs_.name("u", channel)[0];
        const std::string x = fmt::format("(({})/{})", less_text(name, offset_nT), number_text(kField_nT));
        for (const std::string& text :
             {fmt::format("abs({})", x), x + "^2", x + "^3", fmt::format("sign({})", x)})
          neighbour(s, {name}, 4, text);
        const std::string T = fmt::format("s{}_T_degC", s + 1);
        if (const Scalar* own = scalars_.find(T)) neighbour(s, {name, T}, 5, x + "*" + own->about(own->mean));
      }
    }
  }
  void neighbour(int sensor, std::vector<std::string> covariates, int symbols, const std::string& text) {
    Family& out = add(std::move(covariates), symbols, {text});
    out.foreign_sensor = sensor;
    out.whole_array = false;
    out.of_site = false;
  }

  const std::vector<double> kDecays_s = ratios(80, 3000, 10), kLags_s = ratios(60, 2400, 10);
  static inline const std::array<std::string, 3> kAxes{"ux", "uy", "uz"};
  static inline const std::array<std::string, 4> kReadings{"u", "ux", "uy", "uz"};

  const LawInputs& inputs_;
  Scalars scalars_;
  Grammar out_;
};

}  // namespace

std::size_t Grammar::members() const {
  std::size_t out = 0;
  for (const Family& family : families) out += family.inner.size();
  return out;
}

std::string Grammar::hash() const {
  std::string all;
  for (const Family& family : families)
    for (const double inner : family.inner)
      for (const std::string& column : family.columns(inner)) all += column + ";";
  return sha256_hex(all).substr(0, 8);
}

Grammar grammar(const LawInputs& inputs) { return Writer(inputs).write(); }

}  // namespace mgtd::calib::discovery
