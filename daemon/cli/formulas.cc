// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/formulas.h"

#include <fmt/format.h>

#include <algorithm>

#include "calib/criticism/tests/collinearity.h"
#include "calib/poses/pose_table.h"

namespace mgtd::daemon::cli {

std::vector<calib::criticism::tests::CandidateEffect> formulas_of(const store::PoseSource& source,
                                                                  const calib::fit::FitOptions& options) {
  std::vector<calib::criticism::tests::CandidateEffect> out;
  const int sensors = calib::effects::EffectContext{.table = &source.table, .offset_nT = {}}.sensors();
  for (const store::Definition& d : source.definitions) {
    const bool known = std::any_of(options.effects.begin(), options.effects.end(),
                                   [&](const calib::effects::EffectPtr& e) { return e->name() == d.name; });
    const auto spec = calib::effects::EffectSpec::parse(d.spec);
    if (known || !spec) continue;
    auto candidate = calib::criticism::tests::formula_candidate(*spec, sensors);
    if (!candidate || !candidate->variants.front()->applicable(source.table)) continue;
    if (d.exploratory() && d.found_on == calib::poses::data_hash(source.table))
      fmt::print(stderr, "{} was suggested by this run: what is said of it here is exploratory\n", d.name);
    out.push_back(std::move(*candidate));
  }
  return out;
}

}  // namespace mgtd::daemon::cli
