// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/next_hypotheses.h"

#include <fmt/format.h>

#include <algorithm>

#include "calib/discovery/discover.h"
#include "calib/effects/library/library.h"
#include "daemon/run/law_hypotheses.h"
#include "daemon/store/user_formulas.h"

namespace mgtd::daemon::cli {
namespace {

using calib::design::Hypothesis;
using calib::effects::EffectSpec;

int sensors_of(const store::PoseSource& source) {
  return calib::effects::EffectContext{.table = &source.table, .offset_nT = {}}.sensors();
}

bool is_formula(const std::string& spec) {
  const auto parsed = EffectSpec::parse(spec);
  return parsed && parsed->find("expr") != nullptr;
}

std::string shown(const EffectSpec& spec) {
  const std::string* const expression = spec.find("expr");
  if (expression == nullptr) return spec.text();
  const std::string where = spec.where ? spec.where->text() : std::string();
  return fmt::format("{}{}{}: {}", spec.name, where.empty() ? "" : "@", where, *expression);
}

/// The model without the effects of a hypothesis.
void leave_out(calib::fit::FitOptions& options, const std::vector<Hypothesis>& hypotheses) {
  for (const Hypothesis& hypothesis : hypotheses) {
    for (const std::string& spec : hypothesis.specs) {
      const auto parsed = EffectSpec::parse(spec);
      std::erase_if(options.effects, [&](const calib::effects::EffectPtr& e) {
        return e->spec() == spec || (parsed && parsed->find("expr") != nullptr && e->name() == parsed->name);
      });
    }
  }
}

/// The model without what `gone` is, and the descriptions of it.
Result<Question> asked_of(const std::vector<std::string>& specs, const store::PoseSource& source,
                          const calib::fit::FitOptions& options) {
  std::vector<EffectSpec> parsed;
  std::optional<calib::effects::Where> place;
  for (const std::string& text : specs) {
    auto spec = EffectSpec::parse(store::whole_spec(text, source.definitions));
    if (!spec) return tl::unexpected(spec.error());
    spec->sensors = sensors_of(source);
    if (spec->where && !place) place = spec->where;
    parsed.push_back(*std::move(spec));
  }
  Question out{.options = options, .hypotheses = {}};
  for (EffectSpec& spec : parsed) {
    if (!spec.where && place) {
      EffectSpec there = spec;
      there.where = place;
      if (calib::effects::library::make_effect(there)) spec = there;
    }
    if (const auto effect = calib::effects::library::make_effect(spec); !effect)
      return tl::unexpected(effect.error());
    out.hypotheses.push_back({.name = shown(spec), .specs = {spec.text()}, .P = {}});
  }
  leave_out(out.options, out.hypotheses);
  return out;
}

}  // namespace

bool names_of_the_library(const std::vector<std::string>& named, const store::PoseSource& source) {
  return std::all_of(named.begin(), named.end(), [&](const std::string& text) {
    return text.find_first_of("@,") == std::string::npos &&
           !is_formula(store::whole_spec(text, source.definitions));
  });
}

Result<Question> question_of(const std::vector<std::string>& named, const store::PoseSource& source,
                             const calib::fit::FitOptions& options) {
  return asked_of(named, source, options);
}

Result<Question> question_in_doubt(const std::vector<calib::criticism::search::Choice>& doubts,
                                   const store::PoseSource& source, const calib::fit::FitOptions& options) {
  for (const calib::criticism::search::Choice& choice : doubts) {
    if (choice.alternatives.empty()) continue;
    std::vector<std::string> specs{choice.spec};
    specs.insert(specs.end(), choice.alternatives.begin(), choice.alternatives.end());
    const bool any = std::any_of(specs.begin(), specs.end(), [&](const std::string& spec) {
      return is_formula(store::whole_spec(spec, source.definitions));
    });
    if (any) return asked_of(specs, source, options);
  }
  return Question{.options = options, .hypotheses = {}};
}

Result<Question> question_by_discovery(const std::string& place, const store::PoseSource& source,
                                       const calib::fit::FitOptions& options) {
  Question out{.options = options, .hypotheses = {}};
  const auto found = calib::discovery::discover(source.table, {.fit = options, .checks = false});
  if (!found) return tl::unexpected(found.error());
  using calib::discovery::LawFinding;
  if (found->finding == LawFinding::pass || found->finding == LawFinding::noise_like ||
      found->finding == LawFinding::library)
    return out;
  const auto asked = [&](const calib::discovery::FoundLaw& law) {
    return law.formulas.size() > 1 && (place.empty() || law.formulas.front().where == place);
  };
  const auto law = std::find_if(found->laws.begin(), found->laws.end(), asked);
  if (law == found->laws.end()) return out;
  out.hypotheses = run::hypotheses_of(*law, sensors_of(source));
  run::add_laws_beside(*found, static_cast<std::size_t>(law - found->laws.begin()), sensors_of(source),
                       out.options);
  return out;
}

}  // namespace mgtd::daemon::cli
