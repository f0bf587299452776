// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/keep_discovery.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>

#include "calib/criticism/tests/collinearity.h"
#include "calib/poses/pose_table.h"
#include "daemon/store/kept_discovery.h"
#include "daemon/store/user_formulas.h"
#include "proto/time.h"

namespace mgtd::daemon::cli {
namespace {

using calib::discovery::FoundFormula;
using calib::discovery::FoundLaw;
using calib::effects::EffectSpec;

std::string now_text() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return fmt::format("{:.19}Z",
                     format_utc({std::chrono::duration_cast<std::chrono::nanoseconds>(now).count()}));
}

store::Discovered discovered(const FoundLaw& law, std::string_view word, const std::string& data_hash) {
  store::Discovered out{.word = std::string(word),
                        .P = law.formulas.front().P,
                        .others = {},
                        .more = law.more,
                        .data_hash = data_hash};
  for (std::size_t i = 1; i < law.formulas.size(); ++i) {
    const FoundFormula& f = law.formulas[i];
    out.others.push_back({f.formula, f.where, f.P, f.specs.size() == 1 ? f.specs.front() : std::string()});
  }
  return out;
}

/// The spec under a name that no other formula of the run has.
void give_free_name(EffectSpec& spec, const std::vector<store::Definition>& known) {
  const std::string name = spec.name;
  const auto taken = [&] {
    return std::any_of(known.begin(), known.end(), [&](const store::Definition& d) {
      return d.name == spec.name && d.spec != spec.text();
    });
  };
  for (int i = 2; taken(); ++i) spec.name = fmt::format("{}-{}", name, i);
}

}  // namespace

Result<std::vector<std::string>> keep_discovery(store::RunFile& file, store::PoseSource& source,
                                                const calib::fit::FitOptions& options,
                                                const calib::discovery::DiscoveryReport& found,
                                                nlohmann::json found_json) {
  const std::string hash = calib::poses::data_hash(source.table);
  std::vector<std::string> names;
  for (const FoundLaw& law : found.accounts_for_everything() ? found.laws : std::vector<FoundLaw>{}) {
    for (const std::string& text : law.formulas.front().specs) {
      auto spec = EffectSpec::parse(text);
      if (!spec) return tl::unexpected(spec.error());
      if (spec->find("expr") == nullptr) continue;
      give_free_name(*spec, source.definitions);
      const auto examined = calib::criticism::tests::examine_formula(source.table, options, *spec);
      if (!examined) return tl::unexpected(examined.error());
      const store::Definition definition{
          .name = spec->name,
          .spec = spec->text(),
          .found_on = hash,
          .found = examined->coefficients,
          .confirmed_log10_p = {},
          .discovered = discovered(law, calib::discovery::to_string(found.finding), hash)};
      if (auto kept = keep_formula(file, source, definition); !kept) return tl::unexpected(kept.error());
      names.push_back(spec->name);
    }
  }
  for (const char* of_the_moment : {"text", "commands", "next"}) found_json.erase(of_the_moment);
  const store::KeptDiscovery kept{.data_hash = hash,
                                  .model = calib::effects::specs_of(options.effects),
                                  .at = now_text(),
                                  .found = std::move(found_json)};
  if (auto ok = file.set_document(store::kDiscoveryDocument, store::to_text(kept)); !ok)
    return tl::unexpected(ok.error());
  return names;
}

}  // namespace mgtd::daemon::cli
