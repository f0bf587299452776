// SPDX-License-Identifier: Apache-2.0
// Commands on the model that a run file keeps: add, drop, undo, and its history.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "calib/criticism/search/choice.h"
#include "calib/criticism/search/explain.h"
#include "calib/criticism/search/model_change.h"
#include "calib/effects/laws/live_memory.h"
#include "calib/effects/laws/run_memory.h"
#include "calib/effects/library/library.h"
#include "calib/poses/pose_table.h"
#include "calib/report/choice_json.h"
#include "calib/report/choice_text.h"
#include "calib/report/explain_figures.h"
#include "calib/report/figure_words.h"
#include "calib/report/model_change_report.h"
#include "calib/report/waterfall_report.h"
#include "daemon/cli/command.h"
#include "daemon/cli/doubts.h"
#include "daemon/cli/figures_flag.h"
#include "daemon/cli/formulas.h"
#include "daemon/cli/kept_run.h"
#include "daemon/cli/price_figures.h"
#include "daemon/cli/work_progress.h"

namespace mgtd::daemon::cli {
namespace {

using nlohmann::json;

constexpr const char* kAddHelp =
    "Fits everything again with the effect, says what it bought and what it costs, and keeps it in the run\n"
    "file: fit, compare, explain, improve and apply of that file use the kept model from then on\n"
    "(--with none leaves it). Numbers that were searched (the time of a step, the place of a dipole) are\n"
    "kept as they were found, and so is what else could have stood in its place: explain, next and report\n"
    "say so until other poses settle it. An effect is not kept, unless --force, that makes poses left out\n"
    "worse by more than 1 %, that chance alone would bring in more than one run of twenty, or that makes a\n"
    "standard deviation of the calibration more than 100 times larger.\n\n"
    "  mgt explain run.mgtrun\n"
    "  mgt add axis.offset.temperature@s3.z run.mgtrun\n"
    "  mgt undo run.mgtrun\n\n"
    "--try fits and tells all the same and keeps nothing; it takes a pose table too.\n\n"
    "Exit code 0: kept, or worth keeping. 1: not kept.";

struct ModelArguments {
  std::string effect, run, who;
  bool force{false}, tried{false};
  [[nodiscard]] Keeping keeping() const { return tried ? Keeping::nothing : Keeping::steps; }
  std::shared_ptr<FitFlags> flags;
  FiguresFlag figures;  ///< of add
};

/// What each effect of the model removes from the error; empty without effects, or if a fit fails.
std::optional<calib::criticism::search::Waterfall> waterfall_of(const KeptRun& run,
                                                                const calib::fit::FitOptions& options) {
  if (options.effects.empty()) return std::nullopt;
  auto steps = calib::criticism::search::waterfall(run.source.table, options);
  return steps ? std::optional(std::move(*steps)) : std::nullopt;
}

std::string model_text(const std::vector<std::string>& specs) {
  return specs.empty() ? "no effects" : fmt::format("{}", fmt::join(specs, ", "));
}

/// What each effect takes out, costs and brings, where pictures were asked for.
Result<void> draw(const FiguresFlag& flag, const KeptRun& run,
                  const calib::criticism::search::ModelChange& change,
                  const std::optional<calib::criticism::search::Waterfall>& steps,
                  const calib::fit::FitOptions& options, json& out) {
  const auto drawn = [&] {
    std::vector<calib::report::figures::Figure> figures;
    if (steps) figures.push_back(calib::report::waterfall_of(*steps, change.held_out_after_nT));
    if (const auto stage = calib::criticism::search::model_stage(run.source.table, options)) {
      for (auto& figure : price_figures(run.source.table, *stage)) figures.push_back(std::move(figure));
    }
    return figures;
  };
  return hand_out(flag, drawn, out);
}

/// Keeps the change or says why not, and prints it. `choice`: what the poses said of an effect that is added.
int conclude(const Session& session, const ModelArguments& args, KeptRun& run,
             const calib::criticism::search::ModelChange& change, const std::string& spec,
             const calib::fit::FitOptions& options, const calib::criticism::search::Choice& choice) {
  const bool good = args.force || !change.vetoed(), keep = good && !args.tried;
  json made = calib::report::to_json(change);
  if (!choice.spec.empty()) made["choice"] = calib::report::to_json(choice);
  const auto steps = waterfall_of(run, options);
  json pictures = json::object();
  if (auto drawn = draw(args.figures, run, change, steps, options, pictures); !drawn)
    return print_error(session, drawn.error());
  if (keep) {
    if (auto ok = keep_step(run, change.adding ? "add" : "drop", spec, made); !ok)
      return print_error(session, ok.error());
  }
  if (session.json) {
    json out = std::move(made);
    out.update(pictures);
    out["kept"] = keep;
    out["tried"] = args.tried;
    out["open"] = choice.open() ? calib::report::to_text(choice) : std::string();
    out["waterfall"] = steps ? calib::report::to_json(*steps) : json();
    if (steps)
      out["waterfall"]["figure"] =
          calib::report::words_json(calib::report::waterfall_of(*steps, change.held_out_after_nT));
    print_json(out);
  } else {
    const std::size_t width = table_width(session);
    std::string text = calib::report::to_text(change, width);
    if (steps) text += "\n" + calib::report::to_text(*steps, width);
    if (choice.open()) text += "\n" + calib::report::to_text(choice) + "\n";
    if (keep) text += fmt::format("\nkept in {}; mgt undo takes it back\n", args.run);
    print_text(session, text + (args.tried ? "\ntried: nothing is kept\n" : ""));
  }
  if (!good) {
    for (const calib::criticism::search::Veto veto : change.vetoes())
      fmt::print(stderr, "mgt: not kept: {}\n", calib::report::to_text(change, veto));
    fmt::print(stderr, "     these poses do not support this change; --force keeps it all the same\n");
  }
  return good ? 0 : 1;
}

/// An effect that looks back over the run, and that nothing follows sample by sample.
bool is_left_out_of_stream(const calib::effects::Effect& effect) {
  return effect.missing({}) == calib::effects::laws::kNoMemory && effect.live().memory == nullptr;
}

int run_add(const Session& session, const ModelArguments& args) {
  if (const auto ready = ready_for_figures(session, args.figures); !ready)
    return print_error(session, ready.error());
  auto run = open_kept_run(args.run, *args.flags, args.keeping());
  if (!run) return print_error(session, run.error());
  run->who = args.who;
  const int sensors = calib::effects::EffectContext{.table = &run->source.table, .offset_nT = {}}.sensors();
  const auto effect =
      calib::effects::library::make_effect(store::whole_spec(args.effect, run->source.definitions), sensors);
  if (!effect) return print_error(session, effect.error());
  const auto change = with_progress("add", run->options, [&](const calib::fit::FitOptions& told) {
    return calib::criticism::search::add_effect(run->source.table, told, *effect);
  });
  if (!change) return print_error(session, change.error());
  const auto found = calib::effects::library::make_effect(change->spec, sensors);
  if (!found) return print_error(session, found.error());
  if (is_left_out_of_stream(**found))
    fmt::print(stderr,
               "mgt: {0} looks back over the poses of a run, and samples of a stream have none before them: "
               "mgtd leaves\n     {0} out of the stream and counts its size as uncertainty there\n",
               (*found)->name());
  calib::fit::FitOptions options = run->options;
  options.effects.push_back(*found);
  calib::criticism::search::Choice choice = choice_by_discovery(run->source, **found, options);
  if (!choice.spec.empty()) return conclude(session, args, *run, *change, change->spec, options, choice);
  calib::criticism::search::ExplainOptions without{.fit = run->options,
                                                   .also = formulas_of(run->source, run->options)};
  if (const auto before = with_progress("explain", run->options, [&](const calib::fit::FitOptions& told) {
        without.fit = told;
        return calib::criticism::search::explain(run->source.table, without);
      }))
    choice = calib::criticism::search::choice_of(*before, run->source.table, *found);
  return conclude(session, args, *run, *change, change->spec, options, choice);
}

/// The place of an effect in the kept model, by its name or by its whole spec.
Result<std::size_t> place_of(const KeptRun& run, const std::string& effect) {
  for (std::size_t i = 0; i < run.options.effects.size(); ++i) {
    const calib::effects::Effect& e = *run.options.effects[i];
    if (effect == e.name() || effect == e.spec()) return i;
  }
  return fail(ErrorCode::refused, fmt::format("the model kept in the run holds no {}", effect),
              fmt::format("it holds {}", model_text(run.source.model)));
}

int run_drop(const Session& session, const ModelArguments& args) {
  auto run = open_kept_run(args.run, *args.flags, args.keeping());
  if (!run) return print_error(session, run.error());
  run->who = args.who;
  const auto place = place_of(*run, args.effect);
  if (!place) return print_error(session, place.error());
  const auto change = with_progress("drop", run->options, [&](const calib::fit::FitOptions& told) {
    return calib::criticism::search::drop_effect(run->source.table, told, *place);
  });
  if (!change) return print_error(session, change.error());
  calib::fit::FitOptions options = run->options;
  options.effects.erase(options.effects.begin() + static_cast<std::ptrdiff_t>(*place));
  return conclude(session, args, *run, *change, run->source.model[*place], options, {});
}

int run_undo(const Session& session, const ModelArguments& args) {
  auto run = open_kept_run(args.run, *args.flags);
  if (!run) return print_error(session, run.error());
  run->who = args.who;
  const auto steps = run->file->model_steps();
  if (!steps) return print_error(session, steps.error());
  const auto last = store::undoable(*steps);
  if (!last) {
    return print_error(session,
                       {ErrorCode::refused, "there is nothing to undo: the run keeps the model it began with",
                        "mgt add puts an effect in"});
  }
  if (auto ok = keep_step(*run, "undo", last->spec, json::object()); !ok)
    return print_error(session, ok.error());
  std::vector<store::ModelStep> all = *steps;
  all.push_back({.at = {}, .who = {}, .action = "undo", .spec = last->spec, .result = {}});
  const auto model = store::current_model(all);
  if (session.json) {
    print_json({{"schema", "mgt.undo/1"},
                {"undone", {{"action", last->action}, {"spec", last->spec}}},
                {"model", model}});
  } else {
    fmt::print("taken back: {} {}\nthe model now: {}\n", last->action, last->spec, model_text(model));
  }
  return 0;
}

json step_json(const store::ModelStep& s) {
  return {{"t", format_utc(s.at)},
          {"who", s.who},
          {"action", s.action},
          {"spec", s.spec},
          {"result", json::parse(s.result, nullptr, false)}};
}

json masked_json(const std::vector<store::MaskedPose>& masked) {
  json out = json::array();
  for (const store::MaskedPose& m : masked)
    out.push_back({{"pose", m.number}, {"because", m.because}, {"who", m.who}, {"t", format_utc(m.at)}});
  return out;
}

int run_model(const Session& session, const ModelArguments& args) {
  const auto file = store::RunFile::open(args.run, store::Access::read_only);
  if (!file) return print_error(session, file.error());
  const auto steps = file->model_steps();
  if (!steps) return print_error(session, steps.error());
  const auto source = store::read_run(args.run);
  if (!source) return print_error(session, source.error());
  const auto model = store::current_model(*steps);
  const auto masked = store::masked_poses(*steps);
  const std::string here = calib::poses::data_hash(source->table);
  // Masks make other data of a run: what was found on it before them is no formula of another run.
  const auto not_confirmed = [&](const store::Definition& d) {
    return d.exploratory() && masked.empty() && d.found_on != here;
  };
  if (session.json) {
    json history = json::array();
    for (const store::ModelStep& s : *steps) history.push_back(step_json(s));
    json formulas = json::array();
    for (const store::Definition& d : source->definitions)
      formulas.push_back({{"name", d.name},
                          {"spec", d.spec},
                          {"exploratory", d.exploratory()},
                          {"not_confirmed", not_confirmed(d)},
                          {"discovered", d.discovered ? json(d.discovered->text()) : json()}});
    print_json({{"schema", "mgt.model/1"},
                {"model", model},
                {"history", std::move(history)},
                {"masked", masked_json(masked)},
                {"formulas", std::move(formulas)}});
    return 0;
  }
  std::string text;
  for (const store::ModelStep& s : *steps) {
    const json result = json::parse(s.result, nullptr, false);
    std::string change = residual_change(result, "->");
    if (!change.empty()) change = "residual " + change;
    text +=
        fmt::format("{:.19}Z  {:<5} {:<36} {:<30} {}\n", format_utc(s.at), s.action, s.spec, change, s.who);
  }
  text += fmt::format("the model: {}\n", model_text(model));
  for (const store::MaskedPose& m : masked) text += fmt::format("masked: pose {}: {}\n", m.number, m.because);
  for (const store::Definition& d : source->definitions)
    text += fmt::format("formula: {}{}{}\n", d.spec,
                        not_confirmed(d)  ? " (not confirmed here)"
                        : d.exploratory() ? " (exploratory)"
                                          : "",
                        d.discovered ? "; " + d.discovered->text() : "");
  print_text(session, text);
  return 0;
}

CLI::App* add_run_argument(CLI::App* command, ModelArguments& args) {
  command->add_option("RUN", args.run, "*.mgtrun")->required();
  return command;
}

}  // namespace

void add_add(CLI::App& app, Session& session) {
  auto args = std::make_shared<ModelArguments>();
  CLI::App* const command = add_command(app, session, "add", "put an effect into the model a run file keeps",
                                        [args, &session] { return run_add(session, *args); });
  command->footer(kAddHelp);
  command->add_option("EFFECT", args->effect, "NAME[@WHERE][,PARAM=VALUE]: see mgt effects")->required();
  add_run_argument(command, *args);
  add_figures_flag(command, args->figures);
  command->add_flag("--force", args->force, "keep it even if these poses speak against it");
  command->add_flag("--try", args->tried, "fit and tell, keep nothing");
  add_who_option(command, args->who);
  args->flags = add_current_model_flags(command);
}

void add_drop(CLI::App& app, Session& session) {
  auto args = std::make_shared<ModelArguments>();
  CLI::App* const command =
      add_command(app, session, "drop", "take an effect out of the model a run file keeps",
                  [args, &session] { return run_drop(session, *args); });
  command->add_option("EFFECT", args->effect, "its name, or its whole spec")->required();
  add_run_argument(command, *args);
  command->add_flag("--force", args->force, "take it out even if held-out poses get worse");
  command->add_flag("--try", args->tried, "fit and tell, keep nothing");
  add_who_option(command, args->who);
  args->flags = add_current_model_flags(command);
}

void add_undo(CLI::App& app, Session& session) {
  auto args = std::make_shared<ModelArguments>();
  CLI::App* const command = add_command(
      app, session, "undo", "take the last step back (add, drop, mask, unmask); repeat it for the one before",
      [args, &session] { return run_undo(session, *args); });
  add_run_argument(command, *args);
  add_who_option(command, args->who);
  args->flags = std::make_shared<FitFlags>();
}

void add_model(CLI::App& app, Session& session) {
  auto args = std::make_shared<ModelArguments>();
  CLI::App* const command = add_command(app, session, "model", "the model a run file keeps, and its history",
                                        [args, &session] { return run_model(session, *args); });
  add_run_argument(command, *args);
}

}  // namespace mgtd::daemon::cli
