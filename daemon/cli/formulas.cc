// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/formulas.h"

#include <fmt/format.h>

#include <algorithm>

#include "calib/criticism/tests/collinearity.h"
#include "calib/poses/pose_table.h"

namespace mgtd::cli {

std::vector<calib::CandidateEffect> formulas_of(const daemon::PoseSource& source,
                                                const calib::FitOptions& options) {
  std::vector<calib::CandidateEffect> out;
  for (const daemon::Definition& d : source.definitions) {
    const bool known = std::any_of(options.effects.begin(), options.effects.end(),
                                   [&](const calib::EffectPtr& e) { return e->name() == d.name; });
    const auto spec = calib::EffectSpec::parse(d.spec);
    if (known || !spec) continue;
    auto candidate = calib::formula_candidate(*spec);
    if (!candidate || !candidate->variants.front()->check(source.table)) continue;
    if (d.exploratory() && d.found_on == calib::data_hash(source.table))
      fmt::print(stderr, "{} was suggested by this run: what is said of it here is exploratory\n", d.name);
    out.push_back(std::move(*candidate));
  }
  return out;
}

}  // namespace mgtd::cli
