// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/factor.h"

#include <algorithm>

namespace mgtd::calib::discovery {

Factor factor(const Scalar& s) {
  return {s.about(s.mean), s.about(s.zero), s.covariate, s.symbols, s.foreign_sensor, s.common};
}

Family product(const Factor& a, const Factor& b, int symbols) {
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
  return {.covariates = std::move(covariates),
          .symbols = symbols,
          .inner = which,
          .columns = [forms](double i) { return Columns{forms[static_cast<std::size_t>(i)]}; },
          .foreign_sensor = std::max(a.foreign_sensor, b.foreign_sensor),
          .common = a.common && b.common};
}

}  // namespace mgtd::calib::discovery
