// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/gain_families.h"

#include <fmt/format.h>

#include "calib/discovery/factor.h"
#include "calib/discovery/formula_parts.h"

namespace mgtd::calib::discovery {
namespace {

constexpr int kGainHarmonics = 3;

/// A reading, or a function of it, as a factor.
Factor of_field(const std::string& text, const std::string& reading, int symbols) {
  return {text, text, reading, symbols, -1, false};
}

/// The gain of the axis that reads.
void gain(Family family, GrammarWriter& out) {
  family.covariates.insert(family.covariates.begin(), "u");
  GrammarWriter::reads(out.add(std::move(family)), "u");
}

void gains_of_scalar(const Scalar& s, GrammarWriter& out) {
  const Factor x = of_field(over_field("u"), "u", 1);
  out.add(product(x, factor(s), s.symbols + 2));
  if (!s.curve) return;
  Factor square = factor(s);
  square.about_mean += "^2", square.about_zero = square.about_mean;
  out.add(product(x, square, s.symbols + 3));
  if (s.foreign_sensor >= 0) return;
  for (const std::string& axis : kAxes) {
    const Factor other = of_field(over_field(axis), axis, 1);
    GrammarWriter::reads(out.add(product(other, factor(s), s.symbols + 3)), axis);
  }
  const std::string size = fmt::format("abs({})", over_field("u")), x2 = over_field("u") + "^2";
  for (const std::string& of : {size, x2}) out.add(product(of_field(of, "u", 2), factor(s), s.symbols + 3));
  if (s.deciles.empty()) return;
  const std::string u = over_field("u") + "*";
  gain({.covariates = {s.covariate},
        .symbols = s.symbols + 4,
        .inner = s.deciles,
        .columns = [u, s](double c) { return Columns{fmt::format("{}max(0, {})", u, s.about(c))}; },
        .refined = true},
       out);
  gain({.covariates = {s.covariate},
        .symbols = s.symbols + 4,
        .inner = s.deciles,
        .columns = [u, s](double c) { return Columns{fmt::format("{}({}>{})", u, s.text, number_text(c))}; },
        .refined = true},
       out);
}

void gains_of_heat(const Scalar& T, GrammarWriter& out) {
  const std::string u = over_field("u") + "*";
  GrammarWriter::reads(out.add({"u", "T_degC"}, 4, {u + "rate_T_degC"}), "u");
  gain({.covariates = {"T_degC"},
        .symbols = 5,
        .inner = lags_s(),
        .inner_unit = "s",
        .columns =
            [u, T](double tau) {
              return Columns{fmt::format("{}({})", u, less_text(lag(tau, T.covariate), T.mean))};
            },
        .refined = true},
       out);
}

void gains_of_time(GrammarWriter& out) {
  const std::string u = over_field("u") + "*";
  gain({.covariates = {"t_h"},
        .symbols = 5,
        .inner = decays_s(),
        .inner_unit = "s",
        .columns = [u](double tau) { return Columns{u + decay(tau)}; },
        .refined = true},
       out);
  gain({.covariates = {"t_h"},
        .symbols = 6,
        .inner = periods_h(out.inputs()),
        .inner_unit = kPeriodUnit,
        .columns = [u](double hours) { return period(hours, u); },
        .whole_array = false,
        .refined = true},
       out);
}

void gains_of_angle(const std::string& angle, GrammarWriter& out) {
  const std::string u = over_field("u") + "*";
  for (int n = 1; n <= kGainHarmonics; ++n) {
    const std::string sin = fmt::format("{}sind({}*{})", u, n, angle),
                      cos = fmt::format("{}cosd({}*{})", u, n, angle);
    for (const Columns& columns : {Columns{sin}, Columns{cos}, Columns{sin, cos}})
      GrammarWriter::reads(out.add({"u", angle}, 5, columns), "u");
  }
}

}  // namespace

void write_gain_families(GrammarWriter& out) {
  const Scalars& scalars = out.scalars();
  for (const Scalar& s : scalars.all)
    if (!s.covariate.ends_with("_deg")) gains_of_scalar(s, out);
  out.add(product(of_field(over_field("u"), "u", 1), {"cos(pi*pose)", "cos(pi*pose)", "pose"}, 3));
  if (scalars.find("t_h") != nullptr) {
    if (const Scalar* T = scalars.find("T_degC")) gains_of_heat(*T, out);
    gains_of_time(out);
  }
  for (const std::string& angle : scalars.angles) gains_of_angle(angle, out);
}

}  // namespace mgtd::calib::discovery
