// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/report_wishes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "calib/criticism/search/evidence.h"
#include "calib/criticism/search/model_stage.h"
#include "calib/criticism/search/stand_ins.h"
#include "calib/criticism/tests/residual_columns.h"
#include "calib/discovery/remaining_law.h"
#include "calib/fit/joint/effect_impact.h"
#include "calib/poses/pose_table.h"
#include "calib/report/discovery_report.h"
#include "calib/report/explain_figures.h"
#include "calib/report/panel_figures.h"
#include "calib/report/parameter_history.h"
#include "calib/report/run_figures.h"
#include "daemon/acquire/calibrated_with.h"
#include "daemon/cli/calibration_file.h"
#include "daemon/cli/doubts.h"
#include "daemon/cli/formulas.h"
#include "daemon/cli/price_figures.h"
#include "daemon/cli/run_file_content.h"
#include "daemon/cli/search_figures.h"
#include "daemon/store/kept_discovery.h"
#include "daemon/store/run_file.h"
#include "proto/shell_word.h"

namespace mgtd::daemon::cli {
namespace {

using calib::criticism::tests::Comparison;
using calib::criticism::tests::ResidualColumns;
using calib::report::ReportContent;
using Effects = std::vector<calib::effects::EffectPtr>;

bool same_model(const Effects& a, const Effects& b) {
  return calib::effects::specs_of(a) == calib::effects::specs_of(b);
}

calib::fit::FitOptions with_model(calib::fit::FitOptions options, const Effects& effects) {
  options.effects = effects;
  return options;
}

/// A model of the run with what it leaves at each pose.
struct SeenModel {
  Comparison comparison;
  ResidualColumns left;
};

Result<SeenModel> seen(const ReportContent& c, const calib::fit::FitOptions& asked, const Effects& effects) {
  auto comparison = same_model(asked.effects, effects)
                        ? Result<Comparison>(c.comparison)
                        : calib::criticism::tests::compare(c.table, with_model(asked, effects));
  if (!comparison) return tl::unexpected(comparison.error());
  auto left = calib::criticism::tests::residual_columns(*comparison->fit);
  if (!left) return tl::unexpected(left.error());
  return SeenModel{std::move(*comparison), std::move(*left)};
}

/// Nine panels, with the effects that the search ended with beside the bare model, and how the run was
/// measured.
Result<void> draw_panels(const calib::fit::FitOptions& asked, std::optional<double> wanted_nT_per_m,
                         ReportContent& c) {
  const Effects& whole = c.explained.model;
  const auto bare = seen(c, asked, {});
  if (!bare) return tl::unexpected(bare.error());
  const calib::report::PanelModel before{bare->comparison, bare->left};
  std::optional<SeenModel> wide;
  if (!whole.empty()) {
    auto found = seen(c, asked, whole);
    if (!found) return tl::unexpected(found.error());
    wide = *std::move(found);
  }
  const calib::report::PanelModel last =
      wide ? calib::report::PanelModel{wide->comparison, wide->left} : before;
  c.drawn.panels = calib::report::panel_figures(before, wide ? &last : nullptr);
  c.drawn.measured.push_back(calib::report::coverage_of(last));
  if (auto accuracy = calib::report::accuracy_of(c.table, with_model(asked, whole), wanted_nT_per_m))
    c.drawn.measured.push_back(std::move(*accuracy));
  c.drawn.measured.push_back(calib::report::time_figure(last));
  if (auto closure = calib::report::closure_figure(last)) c.drawn.measured.push_back(std::move(*closure));
  return {};
}

/// What the effects of the whole model take out, cost and bring. A fit that refuses leaves its figure out.
void draw_effects(const calib::fit::FitOptions& asked, ReportContent& c) {
  const PoseTable& table = c.table;
  const auto options = with_model(asked, c.explained.model);
  const auto stage = calib::criticism::search::model_stage(table, options);
  if (!stage) return;
  if (auto steps = calib::criticism::search::waterfall(table, options)) {
    const auto& held_out = stage->held_out;
    c.drawn.falls.push_back(
        calib::report::waterfall_of(*steps, held_out ? std::optional(held_out->residual_nT) : std::nullopt));
  }
  c.drawn.prices = price_figures(table, *stage);
}

Result<void> draw_earlier(const ReportWishes& wishes, const FitFlags& flags, ReportContent& c) {
  if (wishes.earlier.empty()) return {};
  std::vector<calib::calibration::Calibration> all{c.fit.calibration};
  const store::PlacedFile first{wishes.run, c.fit.calibration.geometry};
  if (auto ok = continues(first, c.fit.calibration, wishes.run); !ok) return ok;
  FitFlags placed = flags;
  placed.known_places = first.places;
  for (const std::string& path : wishes.earlier) {
    auto calibration = calibration_of(path, placed);
    if (!calibration) return tl::unexpected(calibration.error());
    if (auto ok = continues(first, *calibration, path); !ok) return ok;
    all.push_back(std::move(*calibration));
  }
  if (auto figure = calib::report::history_of(calib::report::moves_among(std::move(all))))
    c.drawn.earlier.push_back(std::move(*figure));
  return {};
}

std::vector<InstrumentIdentity> instruments_of(const std::string& run, const store::PoseSource& source) {
  if (!source.header) return {};
  const auto file = store::RunFile::open(run, store::Access::read_only);
  if (!file) return {};
  const auto known = file->checks(acquire::kInstrumentsStage);
  return known ? acquire::instruments_among(*known) : std::vector<InstrumentIdentity>{};
}

std::vector<run::RunJudgement> judgements_of(const std::string& run, const store::PoseSource& source) {
  if (!source.header) return {};
  const auto file = store::RunFile::open(run, store::Access::read_only);
  const auto text = file ? file->document(run::kJudgements) : Result<std::optional<std::string>>{};
  auto judgements = run::judgements_from_json(text && *text ? **text : std::string());
  return judgements ? *std::move(judgements) : std::vector<run::RunJudgement>{};
}

std::string searched_beside(const std::vector<std::string>& specs) {
  return specs.empty() ? "the sensors' parameters alone" : fmt::format("{}", fmt::join(specs, ", "));
}

/// A law that takes the place of effects, of a run that keeps none.
Result<void> show_law(const calib::discovery::RemainingLaw& law, ReportContent& c) {
  auto pages = calib::report::law_pages(calib::report::to_json(*law.found, c.run));
  if (!pages) return tl::unexpected(pages.error());
  c.laws = *std::move(pages);
  c.laws_note = fmt::format("Searched for this report beside {}; mgt explain says how to keep it.",
                            searched_beside(calib::effects::specs_of(law.model)));
  return {};
}

/// What `mgt discover --keep` found on this run, at whatever model it had then.
Result<void> read_laws(const ReportWishes& wishes, const store::PoseSource& source, ReportContent& c) {
  if (!source.header) return {};
  const auto file = store::RunFile::open(wishes.run, store::Access::read_only);
  if (!file) return tl::unexpected(file.error());
  const auto text = file->document(store::kDiscoveryDocument);
  if (!text) return tl::unexpected(text.error());
  if (!*text) return {};
  const auto kept = store::discovery_from_text(**text);
  if (!kept) return tl::unexpected(kept.error());
  auto pages = calib::report::law_pages(kept->found);
  if (!pages) return tl::unexpected(pages.error());
  c.laws = *std::move(pages);
  c.laws_note = fmt::format("Searched {} beside {}.", kept->at, searched_beside(kept->model));
  if (kept->data_hash != calib::poses::data_hash(c.table))
    c.laws_note += " The poses of this report are others than those that were searched.";
  return {};
}

}  // namespace

std::string report_command(const ReportWishes& w, const FitFlags& f) {
  std::string out = "mgt report " + shell_word(w.run);
  const auto text = [&](const char* name, const std::string& value) {
    if (!value.empty()) out += fmt::format(" {} {}", name, shell_word(value));
  };
  for (const std::string& further : f.further) text("--and", further);
  text("--without", f.without);
  for (const std::string& effect : f.with) text("--with", effect);
  for (const auto& [name, value] : field_options(f)) text(name.c_str(), value);
  text("--operator", w.operator_name);
  text("--site", w.site);
  for (const std::string& earlier : w.earlier) text("--earlier", earlier);
  text("-o", w.output);
  return out;
}

Result<ReportContent> report_content(const ReportWishes& wishes, const FitFlags& flags,
                                     calib::fit::RoundListener on_round) {
  auto source = read_source(wishes.run, flags);
  if (!source) return tl::unexpected(source.error());
  auto options = fit_options(flags, *source);
  if (!options) return tl::unexpected(options.error());
  options->on_round = std::move(on_round);
  auto fitted = calib::fit::method_choice::fit(source->table, *options);
  if (!fitted) return tl::unexpected(fitted.error());
  auto comparison = calib::criticism::tests::compare(source->table, *options);
  if (!comparison) return tl::unexpected(comparison.error());
  const calib::criticism::search::ExplainOptions search{
      .fit = *options, .also = formulas_of(*source, *options), .confusion = true};
  auto explained = calib::criticism::search::explain(source->table, search);
  if (!explained) return tl::unexpected(explained.error());
  std::optional<calib::discovery::RemainingLaw> law;
  if (explained->finding == calib::criticism::search::Finding::partial)
    law = calib::discovery::law_instead(source->table, {.fit = *options, .checks = false}, explained->model);
  if (law) calib::criticism::search::take_back_stand_ins(law->instead_of, *explained);
  auto history = history_of(wishes.run, *source);
  if (!history) return tl::unexpected(history.error());
  auto doubts = doubts_of(wishes.run, *source, *options);
  if (!doubts) return tl::unexpected(doubts.error());
  auto instruments = instruments_of(wishes.run, *source);
  auto file = run_file_content(*source, judgements_of(wishes.run, *source), *history);
  // Fits point to the poses; moving a table moves none of them.
  ReportContent out{.run = std::filesystem::path(wishes.run).filename().string(),
                    .table = std::move(source->table),
                    .file = std::move(file),
                    .instruments = std::move(instruments),
                    .operator_name = wishes.operator_name,
                    .site = wishes.site,
                    .fit = std::move(*fitted),
                    .comparison = std::move(*comparison),
                    .explained = std::move(*explained),
                    .doubts = std::move(*doubts),
                    .command = report_command(wishes, flags)};
  const std::optional<double> wanted =
      source->header ? source->header->options.until_tensor_sd_nT_per_m : std::nullopt;
  if (auto drawn = draw_panels(*options, wanted, out); !drawn) return tl::unexpected(drawn.error());
  if (!out.explained.model.empty()) draw_effects(*options, out);
  out.drawn.candidates = candidate_figures(out.table, search, out.explained);
  out.drawn.limits = limit_figures(out.explained);
  if (auto drawn = draw_earlier(wishes, flags, out); !drawn) return tl::unexpected(drawn.error());
  if (auto read = read_laws(wishes, *source, out); !read) return tl::unexpected(read.error());
  if (law && out.laws.empty())
    if (auto shown = show_law(*law, out); !shown) return tl::unexpected(shown.error());
  return out;
}

}  // namespace mgtd::daemon::cli
