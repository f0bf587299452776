// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/scalar_families.h"

#include <fmt/format.h>

#include "calib/discovery/formula_parts.h"

namespace mgtd::calib::discovery {
namespace {

constexpr int kAngleHarmonics = 6;

void curves(const Scalar& s, GrammarWriter& out) {
  out.on(s, 0, {s.text});
  if (!s.curve) return;
  const std::string u = s.about(s.mean);
  out.on(s, 1, {u + "^2"});
  out.on(s, 2, {u + "^3"});
  out.on(s, 2, {u + "^4"});
  out.on(s, 1, {fmt::format("abs({})", u)});
  out.on(s, 2, {u, u + "^2"});
  if (s.deciles.empty()) return;
  out.on(s, 3, s.deciles, "", [s](double c) { return Columns{s.about(c) + "^3"}; });
  out.on(s, 2, s.deciles, "",
         [t = s.text](double c) { return Columns{fmt::format("({}>{})", t, number_text(c))}; });
  out.on(s, 2, s.deciles, "", [s](double c) { return Columns{fmt::format("max(0, {})", s.about(c))}; });
  out.on(s, 2, s.deciles, "",
         [t = s.text](double c) { return Columns{fmt::format("max(0, {}-{})", number_text(c), t)}; });
}

void time(GrammarWriter& out) {
  const Scalar* t = out.scalars().find("t_h");
  if (t == nullptr) return;
  out.on(*t, 1, {"sqrt(max(t_h, 0))"});
  out.on(*t, 2, decays_s(), "s", [](double tau) { return Columns{decay(tau)}; });
  out.on(*t, 3, periods_h(out.inputs()), kPeriodUnit, [](double hours) { return period(hours, ""); })
      .whole_array = false;
}

void heat(const Scalar& T, GrammarWriter& out) {
  if (out.scalars().find("t_h") == nullptr) return;
  const std::string rate = "rate_" + T.covariate;
  out.on(T, 2, lags_s(), "s", [of = T.covariate](double tau) { return Columns{lag(tau, of)}; });
  out.on(T, 1, {rate});
  out.on(T, 3, {T.about(T.mean), rate});
}

void harmonics(const std::string& angle, GrammarWriter& out) {
  for (int n = 1; n <= kAngleHarmonics; ++n) {
    const std::string sin = fmt::format("sind({}*{})", n, angle), cos = fmt::format("cosd({}*{})", n, angle);
    for (const Columns& columns : {Columns{sin}, Columns{cos}, Columns{sin, cos}})
      out.add({angle}, 3, columns);
  }
  if (angle != "azimuth_deg") out.add({angle}, 3, {fmt::format("abs(sind({}))", angle)});
}

void gravity(GrammarWriter& out) {
  if (out.scalars().angles.size() < 3) return;
  const Columns g{kGravity.begin(), kGravity.end()};
  for (const std::string& component : g) out.add({"gravity"}, 3, {component});
  out.add({"gravity"}, 4, {g[0], g[1]});
  out.add({"gravity"}, 4, g);
}

}  // namespace

void write_scalar_families(GrammarWriter& out) {
  for (const Scalar& s : out.scalars().all) curves(s, out);
  time(out);
  for (const Scalar& s : out.scalars().all)
    if (s.covariate.ends_with("T_degC")) heat(s, out);
  for (const std::string& angle : out.scalars().angles) harmonics(angle, out);
  gravity(out);
}

}  // namespace mgtd::calib::discovery
