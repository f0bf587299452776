// SPDX-License-Identifier: Apache-2.0
#include "calib/poses/import_map.h"

#include <fmt/format.h>

#include <array>

#include "proto/units.h"

namespace mgtd::calib::poses {
namespace {

struct Unit {
  std::string_view suffix, name;
  UnitStep step;
};

const std::array<Unit, 28>& units() {
  static const std::array<Unit, 28> kUnits{{{"_nT", "nT", {1, 0}},         {"_nT", "pT", {1e-3, 0}},
                                            {"_nT", "uT", {1e3, 0}},       {"_nT", "mT", {1e6, 0}},
                                            {"_nT", "T", {1e9, 0}},        {"_nT", "G", {1e5, 0}},
                                            {"_nT", "mG", {1e2, 0}},       {"_nT", "gamma", {1, 0}},
                                            {"_deg", "deg", {1, 0}},       {"_deg", "rad", {to_deg(1.0), 0}},
                                            {"_degC", "degC", {1, 0}},     {"_degC", "K", {1, -273.15}},
                                            {"_degC", "mdegC", {1e-3, 0}}, {"_s", "s", {1, 0}},
                                            {"_s", "ms", {1e-3, 0}},       {"_s", "us", {1e-6, 0}},
                                            {"_s", "ns", {1e-9, 0}},       {"_s", "min", {60, 0}},
                                            {"_s", "h", {3600, 0}},        {"_A", "A", {1, 0}},
                                            {"_A", "mA", {1e-3, 0}},       {"_A", "uA", {1e-6, 0}},
                                            {"_V", "V", {1, 0}},           {"_V", "mV", {1e-3, 0}},
                                            {"_V", "uV", {1e-6, 0}},       {"_m", "m", {1, 0}},
                                            {"_m", "mm", {1e-3, 0}},       {"_m", "km", {1e3, 0}}}};
  return kUnits;
}

}  // namespace

Result<UnitStep> unit_step(std::string_view to, std::string_view unit) {
  std::string known;
  for (const Unit& u : units()) {
    if (!to.ends_with(u.suffix)) continue;
    if (u.name == unit) return u.step;
    known += (known.empty() ? "" : ", ") + std::string(u.name);
  }
  return fail(ErrorCode::bad_input, fmt::format("'{}' is no unit for the column {}", unit, to),
              known.empty() ? "leave `unit` out and give `scale`: the name of this column says no unit"
                            : fmt::format("give one of {}, or `scale`", known));
}

}  // namespace mgtd::calib::poses
