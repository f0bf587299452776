// SPDX-License-Identifier: Apache-2.0
#include "drivers/manual_table.h"

#include <fmt/format.h>

#include <cmath>

#include "proto/units.h"

namespace mgtd::drivers {
namespace {

constexpr double kSayEvery_s = 0.1;

TableLimits::Range limits_of(Settings& settings, const char* key, double most_deg) {
  const auto range = settings.numbers(key, 2, {-most_deg, most_deg});
  if (!(range[0] < range[1]) || std::abs(range[0]) > 720 || std::abs(range[1]) > 720)
    settings.object(key, fmt::format("{} to {} deg is no travel", range[0], range[1]));
  return {to_rad(range[0]), to_rad(range[1])};
}

}  // namespace

std::unique_ptr<Device> ManualTable::make(int /*slot*/, Settings& settings) {
  TableLimits limits;
  limits.azimuth = limits_of(settings, "limits.azimuth", 180);
  limits.pitch = limits_of(settings, "limits.pitch", 90);
  limits.roll = limits_of(settings, "limits.roll", 180);
  return std::make_unique<ManualTable>(limits);
}

void ManualTable::on_open(Stamp now) {
  ++health_.opens;
  health_.state = LinkState::live;
  health_.detail = health_.identity = "turned by hand";
  say(now);
}

void ManualTable::on_tick(Stamp now) {
  if (!last_said_ || to_seconds(now.mono - *last_said_) >= kSayEvery_s) say(now);
}

void ManualTable::on_close(Stamp /*now*/) {
  ++health_.closes;
  health_.state = LinkState::absent;
  health_.detail = "closed";
}

void ManualTable::move_to(TableAngles /*target*/) {
  emit(DeviceFault{now_, "a table that is turned by hand was told to move",
                   "this is a mistake of the program; please report it"});
}

void ManualTable::set(const TableAngles& scales) {
  at_ = scales;
  known_ = true;
}

void ManualTable::say(Stamp now) {
  now_ = now;
  last_said_ = now.mono;
  emit(TableReading{now, at_, referenced_, false, known_});
}

}  // namespace mgtd::drivers
