// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/formula/formula.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "calib/effects/effect_context.h"
#include "calib/effects/formula/formula_effect.h"
#include "calib/effects/formula/history_name.h"
#include "calib/effects/laws/axis_effect.h"
#include "calib/poses/pose_columns.h"
#include "proto/nearest_word.h"
#include "proto/number.h"

namespace mgtd::calib::effects::formula {
namespace {

using Source = FormulaName::Source;

/// Parameters of a spec that are not the formula's own number.
bool reserved(const std::string& key) {
  return key == "level" || key == "unit" || key == "prior" || key == "expr";
}

bool of_gradient(const EffectSpec& spec) {
  const std::string* text = spec.find("level");
  return text != nullptr && *text == "gradient";
}

Result<Level> level_of(const EffectSpec& spec) {
  const std::string* text = spec.find("level");
  if (text == nullptr || *text == "axis") return Level::axis;
  if (*text == "platform") return Level::platform;
  if (*text == "site" || of_gradient(spec)) return Level::site;
  return fail(ErrorCode::usage, fmt::format("{}: '{}' is no level for a formula", spec.name, *text),
              "axis, platform, site or gradient");
}

/// As the user writes it.
std::string_view level_text(const EffectSpec& spec, Level level) {
  if (level == Level::site) return of_gradient(spec) ? "gradient" : "site";
  return level == Level::platform ? "platform" : "axis";
}

Result<Where> place_of(const EffectSpec& spec, Level level) {
  const bool site = level == Level::site;
  if (!spec.where)
    return Where{.scale = site ? Where::Scale::own : Where::Scale::each_axis, .sensors = spec.sensors};
  if (site != (spec.where->scale == Where::Scale::own)) {
    return fail(ErrorCode::usage,
                fmt::format("{} at level {} cannot be laid over '{}'", spec.name, level_text(spec, level),
                            site ? spec.where->text() : "site"),
                site ? "leave the part after '@' out: it has coefficients of its own, for the whole array"
                     : "all, each-sensor, each-axis, a sensor (s3) or an axis (s3.z)");
  }
  Where out = *spec.where;
  out.sensors = spec.sensors;
  return out;
}

/// The formula's own number: its name, and a value or a range.
struct OwnNumber {
  std::optional<std::string> name;
  double value{0};
};

Result<OwnNumber> own_number(const EffectSpec& spec) {
  OwnNumber out;
  for (const auto& [key, text] : spec.parameters) {
    if (reserved(key)) continue;
    if (out.name)
      return fail(ErrorCode::usage,
                  fmt::format("{} has two numbers to look for, {} and {}", spec.name, *out.name, key),
                  "fix one of them in the expression");
    out.name = key;
    const auto value = parse_number(text);
    const auto range = open_scan(spec);
    if (!value && !range) {
      return fail(ErrorCode::usage,
                  fmt::format("{}: {}={} is neither a number nor a range", spec.name, key, text),
                  fmt::format("{}=12 fixes it, {}=2..120 looks for it", key, key));
    }
    out.value = value ? *value : scan_values(*range).at(scan_values(*range).size() / 2);
  }
  return out;
}

Result<void> used(const EffectSpec& spec, const Expression& expression, const OwnNumber& number) {
  const auto& names = expression.names();
  if (number.name && std::find(names.begin(), names.end(), *number.name) == names.end())
    return fail(ErrorCode::usage, fmt::format("{}: {} is not in the expression", spec.name, *number.name),
                "leave it out, or write it into the expression");
  if (names.size() > kFormulaNames)
    return fail(ErrorCode::usage,
                fmt::format("{} names {} things, at most {}", spec.name, names.size(), kFormulaNames),
                "make it of several formulas");
  return {};
}

/// What a gradient is multiplied by: the same at every place, with coefficients that a term can hold.
Result<void> fits_gradient(const EffectSpec& spec, const Expression& expression,
                           const std::vector<FormulaName>& names) {
  for (const FormulaName& name : names) {
    if (name.source == Source::input)
      return tl::unexpected(expression_error(
          expression.text(), column_of(expression.text(), name.name),
          fmt::format("{}: a gradient is the same at every place", spec.name),
          fmt::format("leave {} out, or take level site, where a formula may depend on the place",
                      name.name)));
    if (name.source == Source::coefficient && name.index >= kGradientCoefficients)
      return tl::unexpected(expression_error(
          expression.text(), column_of(expression.text(), name.name),
          fmt::format("{}: a gradient takes k, or k1 and k2, and no {}", spec.name, name.name),
          "make it of several formulas"));
  }
  return {};
}

/// The values of one trial, and the term for given coefficients.
struct Trial {
  const Expression& expression;
  const std::vector<FormulaName>& names;
  std::array<double, kFormulaNames> values{};

  double at(const std::array<double, kFormulaCoefficients>& c) {
    for (std::size_t i = 0; i < names.size(); ++i)
      if (names[i].source == Source::coefficient) values[i] = c[names[i].index];
    return expression({values.data(), names.size()});
  }
};

/// Twice the coefficients is twice the term, no coefficients no term, for anything else held fixed.
Result<void> linear(const EffectSpec& spec, const Expression& expression,
                    const std::vector<FormulaName>& names, Level level) {
  const auto first = std::find_if(names.begin(), names.end(),
                                  [](const FormulaName& n) { return n.source == Source::coefficient; });
  if (first == names.end()) return {};
  constexpr double kRounding = 1e-9;
  std::mt19937_64 rng(1);
  std::uniform_real_distribution<double> around(0.5, 1.5);
  for (int trial = 0; trial < 5; ++trial) {
    Trial t{expression, names};
    for (std::size_t i = 0; i < names.size(); ++i) t.values[i] = around(rng) * usual_size(names[i], level);
    const double nothing = t.at({}), one = t.at({1, -2, 0.5}), other = t.at({0.7, 3, -1});
    const double both = t.at({1.7, 1, -0.5}), size = std::abs(one) + std::abs(other);
    if (!std::isfinite(size + nothing + both)) continue;
    const std::size_t column = column_of(expression.text(), first->name);
    if (std::abs(nothing) > kRounding * size)
      return tl::unexpected(expression_error(
          expression.text(), column, spec.name + " does not vanish when its coefficients are zero",
          "multiply every part of it by a coefficient: what is always there belongs to the calibration"));
    if (std::abs(both - one - other) > kRounding * size)
      return tl::unexpected(expression_error(expression.text(), column,
                                             spec.name + " is not linear in its coefficients",
                                             "give a number that acts otherwise a name of its own, and a "
                                             "range to look for it in (--scan tau=2:120)"));
  }
  return {};
}

/// The sensor whose reading a column is; empty for other columns.
std::optional<int> reading_of(const std::string& column, const PoseTable& table) {
  const auto sensors = static_cast<int>(poses::sensors_of(table));
  for (int sensor = 0; sensor < sensors; ++sensor)
    for (const char axis : {'x', 'y', 'z'})
      if (column == fmt::format("s{}_{}_nT", sensor + 1, axis)) return sensor;
  return std::nullopt;
}

/// The column that a name needs; of another source where it needs none.
FormulaName column_needed(const FormulaName& name, Level level) {
  if (name.source != Source::history) return name;
  const HistoryName looks_back = *history_name(name.name);
  FormulaName of = formula_name(looks_back.of, level, std::nullopt, 0);
  const bool field = of.source == Source::own || of.source == Source::input;
  if (field && looks_back.kind != HistoryName::Kind::previous) of.source = Source::column, of.get = nullptr;
  return of;
}

bool has_column(const PoseTable& table, const FormulaName& column) {
  return column.get && std::any_of(table.poses.begin(), table.poses.end(),
                                   [&](const Pose& pose) { return column.get(pose).has_value(); });
}

/// The levels at which a name stands for a value, "axis or platform"; empty where it may be a column only.
std::string levels_that_know(const std::string& name) {
  const auto history = history_name(name);
  const bool before = history && history->kind == HistoryName::Kind::previous;
  std::vector<std::string_view> out;
  for (const auto& [level, text] : {std::pair{Level::axis, "axis"}, std::pair{Level::platform, "platform"},
                                    std::pair{Level::site, "site"}}) {
    const Source source = formula_name(before ? history->of : name, level, std::nullopt, 0).source;
    if (source != Source::column && source != Source::history) out.emplace_back(text);
  }
  return fmt::format("{}", fmt::join(out, " or "));
}

bool knows_temperatures(const PoseTable& table) {
  return std::any_of(table.poses.begin(), table.poses.end(), [](const Pose& pose) {
    return std::any_of(pose.T_degC.begin(), pose.T_degC.end(), [](const auto& T) { return T.has_value(); });
  });
}

/// What may stand in a formula beside columns.
std::string names_known(const EffectSpec& spec, Level level, const PoseTable& table) {
  if (of_gradient(spec)) return "coefficients k, or k1 and k2; t_h, pose, lag600_X of a column";
  if (level == Level::site) return "coefficients k or k1 to k3; t_h, pose, px, py, pz";
  return fmt::format("coefficients k or k1 to k3; t_h, pose, {}{}",
                     knows_temperatures(table) ? "T_degC, " : "",
                     level == Level::platform ? "b, bx, by, bz, gx, gy, gz" : "u, ux, uy, uz");
}

/// "in reports z stands for uz/50000; " where a name is one of the letters that reports of discover shorten
/// names to.
std::string letter_of_report(const std::string& name, Level level) {
  if (level != Level::axis) return {};
  if (name == "T") return "in reports T stands for T_degC; ";
  if (name != "x" && name != "y" && name != "z") return {};
  return fmt::format("in reports {0} stands for u{0}/{1:.0f}; ", name, kReferenceField_nT);
}

/// ", did you mean 'T1_degC'?" where a column has nearly this name.
std::string meant(const std::string& wrong, const std::vector<std::string>& columns) {
  if (wrong.size() == 1) return {};  // a letter is near to every other
  const auto near = nearest_word(wrong, columns);
  return near ? fmt::format(", did you mean '{}'?", *near) : "";
}

}  // namespace

std::optional<FormulaScan> open_scan(const EffectSpec& spec) {
  if (!is_formula(spec)) return std::nullopt;
  for (const auto& [key, text] : spec.parameters) {
    const auto dots = text.find("..");
    if (reserved(key) || dots == std::string::npos) continue;
    const auto from = parse_number(std::string_view(text).substr(0, dots));
    const auto to = parse_number(std::string_view(text).substr(dots + 2));
    if (from && to && *to > *from) return FormulaScan{key, *from, *to};
  }
  return std::nullopt;
}

std::vector<double> scan_values(const FormulaScan& scan) {
  constexpr int kSteps = 10;
  constexpr double kWide = 5;  ///< beyond this ratio steps are equal ratios
  const bool ratios = scan.from > 0 && scan.to / scan.from > kWide;
  std::vector<double> out;
  for (int i = 0; i < kSteps; ++i) {
    const double share = i / (kSteps - 1.0);
    out.push_back(ratios ? scan.from * std::pow(scan.to / scan.from, share)
                         : scan.from + share * (scan.to - scan.from));
  }
  return out;
}

bool is_formula(const EffectSpec& spec) { return spec.find("expr") != nullptr; }

Result<EffectPtr> make_formula(const EffectSpec& spec) {
  const auto level = level_of(spec);
  if (!level) return tl::unexpected(level.error());
  const auto where = place_of(spec, *level);
  if (!where) return tl::unexpected(where.error());
  const auto prior = spec.number("prior", 0, 0, 1e9);
  if (!prior) return tl::unexpected(prior.error());
  auto expression = Expression::parse(*spec.find("expr"));
  if (!expression) return tl::unexpected(expression.error());
  const auto number = own_number(spec);
  if (!number) return tl::unexpected(number.error());
  if (const auto ok = used(spec, *expression, *number); !ok) return tl::unexpected(ok.error());
  std::vector<FormulaName> names;
  for (const std::string& name : expression->names())
    names.push_back(formula_name(name, *level, number->name, number->value));
  if (of_gradient(spec))
    if (const auto ok = fits_gradient(spec, *expression, names); !ok) return tl::unexpected(ok.error());
  if (const auto ok = linear(spec, *expression, names, *level); !ok) return tl::unexpected(ok.error());
  const std::string* unit = spec.find("unit");
  EffectSpec own = spec;
  own.where = *where;
  return std::make_shared<const FormulaEffect>(std::move(own), *level, of_gradient(spec),
                                               std::move(*expression), std::move(names),
                                               unit != nullptr     ? *unit
                                               : of_gradient(spec) ? "nT/m"
                                                                   : "nT",
                                               *prior);
}

Result<void> check_columns(const EffectSpec& spec, const PoseTable& table) {
  const auto effect = make_formula(spec);
  if (!effect) return tl::unexpected(effect.error());
  const auto& formula = static_cast<const FormulaEffect&>(**effect);
  const std::vector<std::string> there = usable_columns(table);
  for (const FormulaName& name : formula.names()) {
    const FormulaName column = column_needed(name, formula.level());
    if (column.source != Source::column || column.name == "pose") continue;
    const auto wrong = [&](std::string message, std::string remedy) {
      return tl::unexpected(expression_error(*spec.find("expr"), column_of(*spec.find("expr"), name.name),
                                             std::move(message), std::move(remedy)));
    };
    const Level level = formula.level();
    const auto sensor = reading_of(column.name, table);
    const bool now = name.source == Source::column;  // what was read before is not what is explained
    if (now && sensor && !formula.at(*sensor).empty()) {
      if (level == Level::site)
        return wrong(fmt::format("{} acts on every sensor, and '{}' is a reading that it is to explain",
                                 spec.name, name.name),
                     "a law of the site may hold columns that are no readings");
      return wrong(fmt::format("{} acts on s{}, whose reading it is to explain", spec.name, *sensor + 1),
                   level == Level::platform
                       ? "use b, bx, by, bz for the field at the platform"
                       : "use u, ux, uy, uz for the sensor's own field; readings of other sensors may stand "
                         "in a formula");
    }
    if (has_column(table, column)) continue;
    if (const std::string known = levels_that_know(name.name); !known.empty())
      return wrong(fmt::format("'{}' is known at level {}, and {} is of level {}", name.name, known,
                               spec.name, level_text(spec, level)),
                   fmt::format("give another level, or one of the columns {}", fmt::join(there, ", ")));
    return wrong(fmt::format("no pose has a '{}'{}", name.name, meant(name.name, there)),
                 fmt::format("{}columns: {}; {}", letter_of_report(name.name, level), fmt::join(there, ", "),
                             names_known(spec, level, table)));
  }
  return {};
}

}  // namespace mgtd::calib::effects::formula
