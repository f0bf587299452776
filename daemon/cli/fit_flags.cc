// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/fit_flags.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "calib/effects/common_axis.h"
#include "calib/effects/effect_spec.h"
#include "calib/effects/formula/formula.h"
#include "calib/effects/library/library.h"
#include "calib/poses/pose_columns.h"
#include "daemon/cli/in_range.h"
#include "daemon/run/solver.h"
#include "daemon/store/pose_numbers.h"
#include "proto/pose_numbers_text.h"
#include "proto/units.h"

namespace mgtd::daemon::cli {

namespace {

void add_with(CLI::App* command, FitFlags& f) {
  command
      ->add_option("--with", f.with,
                   "effect to put in the model, by name; may be given again (joint). none leaves the model "
                   "that the run file keeps")
      ->allow_extra_args(false);
}

void add_without(CLI::App* command, FitFlags& f) {
  command->add_option("--without", f.without,
                      "leave these poses out this once, by number: 3,7-9 (mgt mask keeps it)");
}

void add_further(CLI::App* command, FitFlags& f) {
  command
      ->add_option("--and", f.further,
                   "a further run of the same rig at the same place, judged together with RUN; may be given "
                   "again")
      ->allow_extra_args(false);
}

void add_site_flags(CLI::App* command, FitFlags& f) {
  add_field_flags(command, f);
  add_array_flags(command, f.array);
  command
      ->add_option(
          "--inclination", f.inclination_deg,
          "inclination of the field in the platform frame at zero table angles, deg, positive towards +Z")
      ->check(in_range(-90, 90, "deg"));
  command
      ->add_option("--declination", f.declination_deg,
                   "declination of the field at zero table angles, from X towards Y, deg")
      ->check(in_range(-360, 360, "deg"));
  add_table_flag(command, f);
  command->add_option("--seed", f.seed, "seed of all random numbers")->check(seed_number());
}

constexpr double kTurn = 6.4;  ///< in radians, rounded up

/// Whether the angles look like radians: every pose has them, and none, in degrees, exceeds 2 pi by number.
bool looks_like_radians(const PoseTable& table) {
  double largest = 0;
  for (const Pose& pose : table.poses) {
    const auto angles = pose.angles();
    if (!angles) return false;
    for (const double a : {angles->azimuth_rad, angles->pitch_rad, angles->roll_rad})
      largest = std::max(largest, std::abs(to_deg(a)));
  }
  return largest > kTurn / 8 && largest <= kTurn;
}

/// Puts one effect into a list; it replaces the same law on the same axes.
void put(std::vector<calib::effects::EffectPtr>& effects, calib::effects::EffectPtr effect) {
  std::erase_if(effects, [&](const calib::effects::EffectPtr& e) {
    return calib::effects::same_law_on_a_common_axis(*e, *effect);
  });
  effects.push_back(std::move(effect));
}

}  // namespace

void add_field_flags(CLI::App* command, FitFlags& flags) {
  command->add_option("--field", flags.field_nT, "total field in nT, for poses without f_nT")
      ->check(in_range(1'000, 200'000, "nT"));
  command->add_option("--field-sd", flags.field_sd_nT, "its standard uncertainty in nT")
      ->check(above_zero(10'000, "nT"));
}

void add_table_flag(CLI::App* command, FitFlags& flags) {
  command->add_option("--table-sd", flags.table_sd_deg, "standard deviation of a table angle in deg (0.1)")
      ->check(above_zero(10, "deg"));
}

std::shared_ptr<FitFlags> add_fit_flags_of_several(CLI::App* command) {
  auto f = std::make_shared<FitFlags>();
  command->add_option("--method", f->method, "simplified, two-step or joint")
      ->check(CLI::IsMember({"simplified", "two-step", "joint"}))
      ->capture_default_str();
  add_with(command, *f);
  add_site_flags(command, *f);
  return f;
}

std::shared_ptr<FitFlags> add_fit_flags(CLI::App* command) {
  auto f = add_fit_flags_of_several(command);
  add_further(command, *f);
  add_without(command, *f);
  return f;
}

std::shared_ptr<FitFlags> add_model_flags(CLI::App* command) {
  auto f = std::make_shared<FitFlags>();
  add_with(command, *f);
  add_further(command, *f);
  add_without(command, *f);
  add_site_flags(command, *f);
  return f;
}

std::shared_ptr<FitFlags> add_current_model_flags(CLI::App* command) {
  auto f = std::make_shared<FitFlags>();
  add_site_flags(command, *f);
  return f;
}

void tell_masked(const store::PoseSource& source) {
  if (source.masked.empty()) return;
  std::set<int> numbers;
  for (const store::MaskedPose& masked : source.masked) numbers.insert(masked.number);
  fmt::print(stderr, "without the masked poses {} (mgt model says why; mgt unmask takes them in again)\n",
             pose_numbers_text(numbers));
}

std::vector<std::pair<std::string, std::string>> field_options(const FitFlags& f) {
  std::vector<std::pair<std::string, std::string>> out;
  const auto number = [&](const char* name, const auto& value) {
    if (value) out.emplace_back(name, fmt::format("{}", *value));
  };
  number("--field", f.field_nT);
  number("--field-sd", f.field_sd_nT);
  number("--inclination", f.inclination_deg);
  number("--declination", f.declination_deg);
  number("--table-sd", f.table_sd_deg);
  number("--seed", f.seed);
  number("--baseline", f.array.baseline_m);
  if (!f.array.array.empty()) out.emplace_back("--array", f.array.array);
  return out;
}

std::vector<std::string> files_read(const std::string& run, const FitFlags& flags) {
  std::vector<std::string> out{run, flags.array.array};
  out.insert(out.end(), flags.further.begin(), flags.further.end());
  return out;
}

Result<store::PoseSource> read_source(const std::string& run, const FitFlags& flags) {
  auto source = store::read_runs(run, flags.further);
  if (source) tell_masked(*source);
  if (source && !flags.without.empty()) {
    const auto numbers = store::parse_pose_numbers(flags.without);
    if (!numbers) return tl::unexpected(numbers.error());
    auto left = store::without_poses(std::move(source->table), *numbers);
    if (!left) return tl::unexpected(left.error());
    source->table = *std::move(left);
  }
  if (source && looks_like_radians(source->table))
    fmt::print(stderr,
               "no table angle is beyond {:.1f} degrees: are they radians? azimuth_deg, pitch_deg and "
               "roll_deg are degrees\n",
               kTurn);
  return source;
}

Result<calib::fit::FitOptions> fit_options(const FitFlags& flags, const store::PoseSource& source) {
  auto kept = run::fit_options(source);
  if (!kept) return tl::unexpected(kept.error());
  calib::fit::FitOptions out = std::move(*kept);
  const auto method = calib::fit::method_from(flags.method);
  if (!method)
    return fail(ErrorCode::usage, "no method '" + flags.method + "'", "simplified, two-step or joint");
  out.method = *method;
  const bool leave = std::find(flags.with.begin(), flags.with.end(), "none") != flags.with.end();
  if (leave || out.method != calib::fit::Method::joint) out.effects.clear();
  if (!out.effects.empty())
    fmt::print(stderr, "with the model kept in the run: {} (--with none ignores it)\n",
               fmt::join(source.model, ", "));
  for (const std::string& name : flags.with) {
    if (name == "none") continue;
    const std::string whole = store::whole_spec(name, source.definitions);
    auto effect = calib::effects::library::make_effect(
        whole, calib::effects::EffectContext{.table = &source.table, .offset_nT = {}}.sensors());
    if (!effect) return tl::unexpected(effect.error());
    if (const auto spec = calib::effects::EffectSpec::parse(whole);
        spec && calib::effects::formula::is_formula(*spec))
      if (const auto ok = calib::effects::formula::check_columns(*spec, source.table); !ok)
        return tl::unexpected(ok.error());
    put(out.effects, *effect);
  }
  if (!out.effects.empty() && out.method != calib::fit::Method::joint) {
    return fail(ErrorCode::usage, "--with needs the joint method", "leave --method out");
  }
  if (flags.field_nT) out.field_nT = flags.field_nT;
  if (flags.field_sd_nT) out.field_sd_nT = *flags.field_sd_nT;
  if (flags.places_needed) {
    const std::optional<calib::sensor::Geometry> own =
        source.header ? std::optional(source.header->options.geometry) : flags.known_places;
    const auto geometry =
        array_for(flags.array, calib::poses::sensors_of(source.table), source.table.source, own);
    if (!geometry) return tl::unexpected(geometry.error());
    out.geometry = *geometry;
  }
  if (flags.inclination_deg) out.inclination_rad = to_rad(*flags.inclination_deg);
  if (flags.declination_deg) out.declination_rad = to_rad(*flags.declination_deg);
  if (flags.table_sd_deg) out.table_sd_rad = to_rad(*flags.table_sd_deg);
  if (flags.seed) out.seed = *flags.seed;
  if (flags.keep_all) out.most_left_out = 0;
  return out;
}

}  // namespace mgtd::daemon::cli
