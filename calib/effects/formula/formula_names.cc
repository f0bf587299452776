// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/formula/formula_names.h"

#include <algorithm>
#include <set>
#include <string_view>

#include "calib/effects/effect_context.h"
#include "calib/effects/formula/history_name.h"
#include "calib/poses/pose_columns.h"

namespace mgtd::calib::effects::formula {
namespace {

using Source = FormulaName::Source;

/// Names of the inputs of a level, in its order; then that of the component along the axis itself.
struct LevelNames {
  std::vector<std::string_view> inputs;
  std::string_view own;
};

LevelNames names_of(Level level) {
  if (level == Level::platform) return {{"bx", "by", "bz", "gx", "gy", "gz"}, "b"};
  if (level == Level::site) return {{"px", "py", "pz"}, ""};
  return {{"ux", "uy", "uz"}, "u"};
}

/// k is the first, k1 .. k3 are numbered.
std::optional<std::size_t> coefficient_index(std::string_view name) {
  if (name == "k") return 0;
  if (name.size() == 2 && name[0] == 'k' && name[1] >= '1' && name[1] <= '3')
    return static_cast<std::size_t>(name[1] - '1');
  return std::nullopt;
}

/// At the site of columns alone: what a sensor read before is none of the site's.
bool looks_back(const std::string& name, Level level) {
  const auto history = history_name(name);
  return history && (level != Level::site ||
                     formula_name(history->of, Level::axis, std::nullopt, 0).source == Source::column);
}

const poses::PoseColumn* format_column(const std::string& name) {
  const auto& all = poses::pose_columns(static_cast<std::size_t>(kMostSensors));
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const poses::PoseColumn& c) { return c.name == name; });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace

double usual_size(const FormulaName& name, Level level) {
  switch (name.source) {
    case Source::number:
      return name.number;
    case Source::own:
      return kReferenceField_nT / 2;
    case Source::input:
      return level == Level::site ? 0.2 : name.index < 3 ? kReferenceField_nT / 2 : 0.5;
    case Source::temperature:
      return kReferenceT_degC;
    case Source::column:
    case Source::history:
      return 10;
    default:
      return 1;
  }
}

FormulaName formula_name(const std::string& name, Level level, const std::optional<std::string>& scanned,
                         double value) {
  FormulaName out{.name = name};
  const LevelNames known = names_of(level);
  if (scanned && name == *scanned) {
    out.source = Source::number, out.number = value;
  } else if (const auto index = coefficient_index(name)) {
    out.source = Source::coefficient, out.index = *index;
  } else if (name == "t_h") {
    out.source = Source::hours;
  } else if (name == "T_degC" && level != Level::site) {
    out.source = Source::temperature;
  } else if (!known.own.empty() && name == known.own) {
    out.source = Source::own;
  } else if (const auto at = std::find(known.inputs.begin(), known.inputs.end(), name);
             at != known.inputs.end()) {
    out.source = Source::input, out.index = static_cast<std::size_t>(at - known.inputs.begin());
  } else if (looks_back(name, level)) {
    out.source = Source::history;
  } else if (name == "pose") {
    out.get = [](const Pose& pose) {
      return pose.number > 0 ? std::optional(static_cast<double>(pose.number)) : std::nullopt;
    };
  } else {
    // A temperature of a sensor that the array does not have may be a column of the user's own.
    out.get = [name, column = format_column(name)](const Pose& pose) {
      if (column != nullptr)
        if (const auto there = column->get(pose)) return there;
      const auto found = pose.covariates.find(name);
      return found == pose.covariates.end() ? std::nullopt : std::optional(found->second);
    };
  }
  return out;
}

std::vector<std::string> usable_columns(const PoseTable& table) {
  std::set<std::string> found;
  const auto& columns = poses::pose_columns(poses::sensors_of(table));
  for (const Pose& pose : table.poses) {
    for (const poses::PoseColumn& column : columns) {
      if (!column.required && !column.name.ends_with("_nT") && column.get(pose)) found.insert(column.name);
    }
    if (pose.f_nT) found.insert("f_nT");
    for (const auto& [name, value] : pose.covariates) found.insert(name);
  }
  return {found.begin(), found.end()};
}

}  // namespace mgtd::calib::effects::formula
