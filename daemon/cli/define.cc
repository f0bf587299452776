// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "calib/criticism/tests/collinearity.h"
#include "calib/effects/formula/angle_unit.h"
#include "calib/effects/formula/formula.h"
#include "calib/effects/library/effect_family.h"
#include "calib/poses/pose_table.h"
#include "calib/report/formula_figure.h"
#include "calib/report/formula_report.h"
#include "daemon/cli/command.h"
#include "daemon/cli/figures_flag.h"
#include "daemon/cli/kept_run.h"
#include "daemon/cli/work_progress.h"
#include "daemon/store/user_formulas.h"
#include "proto/shell_word.h"

namespace mgtd::daemon::cli {
namespace {

using nlohmann::json;

constexpr const char* kDefineHelp =
    R"(An effect by your own formula: the term of one axis, as an expression of what was measured.

  mgt define run.mgtrun lamp 'lamp_A' --level platform --scale each-sensor --unit nT/A
  mgt define run.mgtrun creep 'k*u*exp(-since_stop_s/tau)' --level axis --scan tau=2:120
  mgt define run.mgtrun lift 'k1*sin(2*_pi*t_h/0.15) + k2*cos(2*_pi*t_h/0.15)' --level gradient
  mgt add lamp run.mgtrun ; mgt explain run.mgtrun --with creep

k, k1, k2, k3 are coefficients, which must come in linearly; without one the whole is multiplied by one. Other
names: every column of the run; t_h (hours); T_degC (the sensor's own); at level axis u, ux, uy, uz (field term
of the axis and its sensor, nT); platform b, bx, by, bz (nT), gx, gy, gz (unit gravity); site px, py, pz (m).
At level site the formula is multiplied by a field x, y, z, at level gradient by Gxx, Gyy, Gxy, Gxz, Gyz.
Operators + - * / ^ ?: and comparisons; sind cosd tand of degrees, as the columns azimuth_deg, pitch_deg and
roll_deg are; sin cos tan of radians; exp ln sqrt abs sign min max tanh ...

Says how much of it the calibration absorbs already and which effect of the library it resembles. On the run it
was thought of it stays exploratory; on a second run, --from FIRST.mgtrun confirms it or not.

--try examines it and keeps nothing; it takes a pose table too.

Exit code 0: kept, or worth keeping. 1: not kept (absorbed whole), or not confirmed.)";

struct DefineArguments {
  std::string run, name, expression, level{"axis"}, scale, unit, scan, from;
  std::optional<double> prior;
  bool drop{false}, tried{false};
  std::shared_ptr<FitFlags> flags;
  FiguresFlag figures;
};

bool is_name(const std::string& name) {
  return !name.empty() && std::isalpha(static_cast<unsigned char>(name.front())) != 0 &&
         std::all_of(name.begin(), name.end(), [](char c) {
           return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-' || c == '.';
         });
}

Result<void> usable_name(const std::string& name) {
  if (is_name(name) && name != "none" && calib::effects::library::find_family(name) == nullptr) return {};
  return fail(
      ErrorCode::usage,
      calib::effects::library::find_family(name) != nullptr
          ? name + " is an effect of the library"
          : "'" + name + "' cannot be the name of an effect",
      "use letters, digits, '_', '-' and '.', begin with a letter, and take none that mgt effects lists");
}

/// "tau=2:120" as a parameter of a spec.
Result<std::pair<std::string, std::string>> scan_of(const std::string& text) {
  const auto equals = text.find('='), colon = text.find(':');
  if (equals == std::string::npos || colon == std::string::npos || equals == 0 || colon < equals)
    return fail(ErrorCode::usage, "--scan '" + text + "' is not NAME=FROM:TO",
                "for instance --scan tau=2:120");
  return std::pair{text.substr(0, equals),
                   text.substr(equals + 1, colon - equals - 1) + ".." + text.substr(colon + 1)};
}

Result<calib::effects::EffectSpec> spec_of(const DefineArguments& args) {
  if (const auto ok = usable_name(args.name); !ok) return tl::unexpected(ok.error());
  calib::effects::EffectSpec spec{.name = args.name, .where = {}, .parameters = {}};
  const bool of_site = args.level == "site" || args.level == "gradient";
  if (!args.scale.empty() && of_site)
    return fail(ErrorCode::usage, fmt::format("--scale does not apply at level {}", args.level),
                "leave it out: the formula has coefficients of its own there, for the whole array");
  if (!args.scale.empty()) {
    const auto where = calib::effects::Where::parse(args.scale);
    if (!where) return tl::unexpected(where.error());
    spec.where = *where;
  }
  spec.set("level", args.level);
  if (args.unit.find(',') != std::string::npos)
    return fail(ErrorCode::usage, "a unit has no comma", "for instance --unit nT/A");
  spec.set("unit", !args.unit.empty() ? args.unit : args.level == "gradient" ? "nT/m" : "nT");
  if (args.prior) spec.set("prior", *args.prior);
  if (!args.scan.empty()) {
    auto scan = scan_of(args.scan);
    if (!scan) return tl::unexpected(scan.error());
    spec.set(scan->first, std::move(scan->second));
  }
  spec.set("expr", args.expression);
  return spec;
}

/// The formula as it was defined on another run.
Result<store::Definition> definition_from(const std::string& path, const std::string& name) {
  const auto source = store::read_run(path);
  if (!source) return tl::unexpected(source.error());
  for (const store::Definition& d : source->definitions)
    if (d.name == name) return d;
  return fail(ErrorCode::bad_input, path + " keeps no formula called " + name,
              "mgt model " + path + " lists them");
}

/// Largest difference between the coefficients and those found before, in their joint standard deviations.
double disagreement(const store::Definition& before, const calib::criticism::tests::FormulaExamination& now) {
  double out = 0;
  for (const auto& a : before.found) {
    for (const auto& b : now.coefficients)
      if (a.name == b.name) out = std::max(out, std::abs(a.value - b.value) / std::hypot(a.sd, b.sd));
  }
  return out;
}

/// What this run says of a formula from another one.
struct Confirmation {
  bool asked{false}, given{false};
  double sigmas{0};
};

constexpr double kConfirmed_log10_p = -2;
constexpr double kAllAbsorbed = 0.9995;  ///< in squares

bool nothing_left(const calib::criticism::tests::FormulaExamination& x) {
  return x.wholly_absorbed() || x.absorbed > kAllAbsorbed;
}

constexpr double kAgree_sigmas = 4;

std::string text_of(const DefineArguments& args, const calib::criticism::tests::FormulaExamination& x,
                    const store::Definition& definition, const Confirmation& c) {
  std::string out = calib::report::to_text(x);
  if (x.wholly_absorbed()) return out;
  if (nothing_left(x)) return out + "not kept: nothing of it is left to be seen on these poses\n";
  if (args.tried) return out + "tried: nothing is kept\n";
  if (definition.discovered) out += definition.discovered->text() + "\n";
  const std::string run = shell_word(args.run);
  if (!c.asked) {
    out += fmt::format(
        "exploratory: these poses suggested it, so their p-value proves nothing; a second run does:\n"
        "  mgt define SECOND.mgtrun {} --from {}\n",
        args.name, run);
  } else if (c.given) {
    out += fmt::format(
        "confirmed on a second run; the coefficients differ by {:.1f} standard deviations at most\n",
        c.sigmas);
  } else {
    out += fmt::format(
        "not confirmed: on this run p {:.2g}, and the coefficients differ by {:.1f} standard deviations\n",
        std::pow(10, x.log10_p), c.sigmas);
  }
  return out + fmt::format("kept in {}; mgt add {} {} puts it into the model\n", args.run, args.name, run);
}

void print(const Session& session, const DefineArguments& args,
           const calib::criticism::tests::FormulaExamination& x, const store::Definition& definition,
           const Confirmation& c, json out) {
  if (session.json) {
    out.update(calib::report::to_json(x));
    out["schema"] = "mgt.define/1";
    out["spec"] = definition.spec;
    out["exploratory"] = definition.exploratory();
    out["confirmed"] = c.asked ? json(c.given) : json();
    out["kept"] = !nothing_left(x) && !args.tried;
    out["tried"] = args.tried;
    out["discovered"] = definition.discovered ? json(definition.discovered->text()) : json();
    out["text"] = calib::report::to_text(x);
    print_json(out);
  } else {
    print_text(session, text_of(args, x, definition, c));
  }
}

int drop(const Session& session, const DefineArguments& args, KeptRun& run) {
  std::vector<store::Definition> all = run.source.definitions;
  if (std::erase_if(all, [&](const store::Definition& d) { return d.name == args.name; }) == 0)
    return print_error(session, {ErrorCode::usage, args.run + " keeps no formula called " + args.name,
                                 "mgt model " + args.run + " lists them"});
  for (const calib::effects::EffectPtr& e : run.options.effects) {
    if (e->name() != args.name) continue;
    return print_error(session, {ErrorCode::state, "the model of the run holds " + args.name,
                                 fmt::format("mgt drop {} {} takes it out first", args.name, args.run)});
  }
  if (auto ok = run.file->set_document(store::kFormulasDocument, store::to_text(all)); !ok)
    return print_error(session, ok.error());
  if (session.json) {
    print_json({{"schema", "mgt.define/1"}, {"dropped", args.name}});
  } else {
    fmt::print("the formula {} is deleted\n", args.name);
  }
  return 0;
}

int run_define(const Session& session, const DefineArguments& args) {
  if (const auto ready = ready_for_figures(session, args.figures); !ready)
    return print_error(session, ready.error());
  auto run = open_kept_run(args.run, *args.flags, args.tried ? Keeping::nothing : Keeping::steps);
  if (!run) return print_error(session, run.error());
  if (args.drop && !args.tried) return drop(session, args, *run);
  if (args.from.empty() == args.expression.empty()) {
    return print_error(session,
                       {ErrorCode::usage, "a formula is given, or taken from another run with --from",
                        "mgt define RUN NAME 'EXPR', or mgt define RUN NAME --from OTHER.mgtrun"});
  }
  store::Definition definition;
  const std::string here = calib::poses::data_hash(run->source.table);
  if (args.from.empty()) {
    const auto spec = spec_of(args);
    if (!spec) return print_error(session, spec.error());
    if (const auto ok = calib::effects::formula::check_angles(args.expression); !ok)
      return print_error(session, ok.error());
    definition = {args.name, spec->text(), here, {}, {}, {}};
  } else {
    auto other = definition_from(args.from, args.name);
    if (!other) return print_error(session, other.error());
    definition = std::move(*other);
    definition.confirmed_log10_p.reset();
  }
  const auto spec = calib::effects::EffectSpec::parse(definition.spec);
  if (!spec) return print_error(session, spec.error());
  if (const auto ok = calib::effects::formula::check_columns(*spec, run->source.table); !ok)
    return print_error(session, ok.error());
  calib::fit::FitOptions options = run->options;
  std::erase_if(options.effects, [&](const calib::effects::EffectPtr& e) { return e->name() == args.name; });
  const auto x = with_progress("define", options, [&](const calib::fit::FitOptions& told) {
    return calib::criticism::tests::examine_formula(run->source.table, told, *spec);
  });
  if (!x) return print_error(session, x.error());
  Confirmation confirmation{.asked = definition.found_on != here};
  if (confirmation.asked) {
    confirmation.sigmas = disagreement(definition, *x);
    confirmation.given = x->log10_p < kConfirmed_log10_p && confirmation.sigmas < kAgree_sigmas;
    if (confirmation.given) definition.confirmed_log10_p = x->log10_p;
  } else {
    definition.found = x->coefficients;
  }
  json figures = json::object();
  const auto draw = [&] {
    return x->wholly_absorbed() ? std::vector<calib::report::figures::Figure>()
                                : std::vector{calib::report::formula_figure(*x)};
  };
  if (auto drawn = hand_out(args.figures, draw, figures); !drawn) return print_error(session, drawn.error());
  if (!nothing_left(*x) && !args.tried) {
    for (const store::Definition& d : run->source.definitions)
      if (d.name == args.name && d.spec != definition.spec) fmt::print(stderr, "this replaces {}\n", d.spec);
    if (auto ok = keep_formula(*run->file, run->source, definition); !ok)
      return print_error(session, ok.error());
  }
  print(session, args, *x, definition, confirmation, std::move(figures));
  return nothing_left(*x) || (confirmation.asked && !confirmation.given) ? 1 : 0;
}

}  // namespace

void add_define(CLI::App& app, Session& session) {
  auto args = std::make_shared<DefineArguments>();
  CLI::App* const command = add_command(app, session, "define", "an effect by your own formula",
                                        [args, &session] { return run_define(session, *args); });
  command->footer(kDefineHelp);
  command->add_option("RUN", args->run, "*.mgtrun")->required();
  command->add_option("NAME", args->name, "what to call it")->required();
  command->add_option("EXPR", args->expression, "the formula");
  command->add_option("--level", args->level, "axis, platform, site or gradient")
      ->check(CLI::IsMember({"axis", "platform", "site", "gradient"}))
      ->capture_default_str();
  command->add_option("--scale", args->scale, "all, each-sensor, each-axis (default), s3, s3.z");
  command->add_option("--unit", args->unit, "unit of its coefficients (default: nT, of a gradient nT/m)");
  command->add_option("--prior", args->prior, "standard deviation of the coefficients about zero");
  command->add_option("--scan", args->scan,
                      "NAME=FROM:TO, a number in it that is searched for in this range");
  add_figures_flag(command, args->figures);
  command->add_flag("--try", args->tried, "examine it, keep nothing");
  command->add_flag("--drop", args->drop, "delete the formula of this name");
  command->add_option("--from", args->from, "run file that keeps the formula: does this run confirm it?");
  args->flags = add_current_model_flags(command);
}

}  // namespace mgtd::daemon::cli
