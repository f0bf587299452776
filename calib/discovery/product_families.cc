// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/product_families.h"

#include <fmt/format.h>

#include "calib/discovery/factor.h"
#include "calib/discovery/formula_parts.h"

namespace mgtd::calib::discovery {
namespace {

Factor squared(Factor of) {
  of.about_mean += "^2", of.about_zero += "^2";
  return of;
}

void heat_and_time(GrammarWriter& out) {
  const Scalar* t = out.scalars().find("t_h");
  if (t == nullptr) return;
  for (const Scalar& T : out.scalars().all) {
    if (!T.covariate.ends_with("T_degC")) continue;
    out.add(product(squared(factor(T)), factor(*t), T.symbols + 3));
    out.add(product(factor(T), squared(factor(*t)), T.symbols + 3));
    out.on(T, 4, lags_s(), "s",
           [T](double tau) {
             return Columns{fmt::format("({})*t_h", less_text(lag(tau, T.covariate), T.mean))};
           })
        .covariates.emplace_back("t_h");
  }
}

}  // namespace

void write_product_families(GrammarWriter& out) {
  std::vector<Factor> factors;
  for (const Scalar& s : out.scalars().all)
    if (s.covariate != "azimuth_deg" && s.covariate != "roll_deg") factors.push_back(factor(s));
  if (out.scalars().all.empty()) return;
  const std::string parity = "cos(pi*pose)";
  out.add({"pose"}, 1, {parity});
  factors.push_back({parity, parity, "pose"});
  for (const std::string& angle : out.scalars().angles)
    for (const char* of : {"sind", "cosd"})
      factors.push_back({fmt::format("{}({})", of, angle), fmt::format("{}({})", of, angle), angle, 2});
  for (std::size_t i = 0; i < factors.size(); ++i)
    for (std::size_t j = i + 1; j < factors.size(); ++j)
      out.add(product(factors[i], factors[j], factors[i].symbols + factors[j].symbols + 1));
  heat_and_time(out);
}

}  // namespace mgtd::calib::discovery
