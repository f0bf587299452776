// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "calib/effects/library/effect_page.h"
#include "calib/effects/library/library.h"
#include "daemon/cli/command.h"

namespace mgtd::daemon::cli {
namespace {

constexpr const char* kEffectsHelp =
    R"(Prints the library of physical effects, or the page of one: cause, formula, units, typical size, how it shows,
what looks alike and how to tell them apart.

  mgt effects                      the list
  mgt effects axis.hysteresis      one page

An effect goes into a model as NAME[@WHERE][,PARAM=VALUE]: mgt fit run.mgtrun --with axis.cubic@s3.z)";

int run(const Session& session, const std::string& name) {
  std::span<const calib::effects::library::EffectFamily> families =
      calib::effects::library::effect_families();
  if (!name.empty()) {
    const calib::effects::library::EffectFamily* family =
        calib::effects::library::find_family(calib::effects::family_name(name));
    if (family == nullptr) return print_error(session, calib::effects::library::make_effect(name).error());
    families = {family, 1};
  }
  if (session.json) {
    print_json(calib::effects::library::effects_json(families));
  } else {
    fmt::print("{}", name.empty() ? calib::effects::library::effect_list()
                                  : calib::effects::library::effect_page(families.front()));
  }
  return 0;
}

}  // namespace

void add_effects(CLI::App& app, Session& session) {
  auto name = std::make_shared<std::string>();
  CLI::App* command = add_command(app, session, "effects", "the library of physical effects",
                                  [&session, name] { return run(session, *name); });
  command->add_option("name", *name, "of one effect");
  command->footer(kEffectsHelp);
}

}  // namespace mgtd::daemon::cli
