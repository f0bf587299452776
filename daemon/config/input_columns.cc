// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/input_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "calib/effects/formula/formula_names.h"
#include "calib/poses/pose_columns.h"

namespace mgtd::daemon::config {
namespace {

/// Of formulas.
constexpr std::array<calib::effects::Level, 3> kLevels{
    calib::effects::Level::axis, calib::effects::Level::platform, calib::effects::Level::site};

/// A name that stands for something else in formulas of one level or another.
bool means_something_else(const std::string& column) {
  return std::any_of(kLevels.begin(), kLevels.end(), [&](calib::effects::Level level) {
    return calib::effects::formula::formula_name(column, level, std::nullopt, 0).source !=
           calib::effects::formula::FormulaName::Source::column;
  });
}

}  // namespace

InputColumns::InputColumns() {
  for (const calib::poses::PoseColumn& column :
       calib::poses::pose_columns(static_cast<std::size_t>(kMostSensors)))
    if (!drivers::sensor_of(column.name)) fixed_.insert(column.name);
}

void InputColumns::add(drivers::Settings& s, const DeviceConfig& device, Config& config) {
  for (const drivers::InputChannel& input : device.device->inputs()) {
    const std::string& column = input.column;
    if (fixed_.contains(column)) {
      s.object(input.key,
               fmt::format("'{}' is a column of the pose table itself; choose another name", column));
    } else if (means_something_else(column)) {
      s.object(input.key, fmt::format("'{}' means something else in formulas; choose another name", column));
    }
    const auto [known, fresh] = measured_.try_emplace(
        column,
        fmt::format("{}, input {}, in line {}", device.name, input.input, s.place_of(input.key).line));
    if (!fresh)
      s.object(input.key, fmt::format("'{}' is already measured ({}); {}", column, known->second,
                                      drivers::sensor_of(column) ? "leave one of the two out"
                                                                 : "give one of them another name"));
    if (const auto sensor = drivers::sensor_of(column);
        sensor && static_cast<std::size_t>(*sensor) >= config.geometry().sensors())
      s.object(input.key,
               fmt::format("'{}' is the temperature of a sensor that the array does not have: it has {}",
                           column, calib::poses::counted(config.geometry().sensors())));
    if (input.unit == "A" && !column.ends_with("_A"))
      config.warnings.push_back(
          fmt::format("{}:{}: warning: {}: '{}' is a current whose name does not end in _A: platform.current "
                      "does not see it",
                      config.file, s.place_of(input.key).line, s.section(), column));
  }
}

}  // namespace mgtd::daemon::config
