// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/laws/platform_bending.h"
#include "calib/effects/laws/platform_current.h"
#include "calib/effects/laws/platform_tabletop_magnet.h"
#include "calib/effects/library/family_parts.h"
#include "calib/effects/library/platform_absorbed.h"
#include "proto/number.h"

namespace mgtd::calib::effects::library {
namespace {

std::vector<std::string> parts_of(std::string_view list) {
  std::vector<std::string> out;
  while (!list.empty()) {
    const std::string_view part = list.substr(0, list.find('/'));
    if (!part.empty()) out.emplace_back(part);
    list.remove_prefix(std::min(part.size() + 1, list.size()));
  }
  return out;
}

Result<EffectPtr> current(const EffectSpec& spec) {
  if (const auto ok = spec.only({"columns"}); !ok) return tl::unexpected(ok.error());
  const auto where = where_of(spec, kSensorScales);
  if (!where) return tl::unexpected(where.error());
  std::vector<std::string> columns;
  if (const std::string* list = spec.find("columns")) columns = parts_of(*list);
  if (columns.size() > laws::PlatformCurrent::kMaxColumns) {
    return fail(ErrorCode::usage, "platform.current: at most three columns at once",
                "name those that change most: columns=motor_A/pump_A");
  }
  return std::make_shared<const laws::PlatformCurrent>(std::move(columns), *where);
}

Result<EffectPtr> tabletop_magnet(const EffectSpec& spec) {
  if (const auto ok = spec.only({"mounts"}); !ok) return tl::unexpected(ok.error());
  if (const auto where = where_of(spec, kOwnScale); !where) return tl::unexpected(where.error());
  std::vector<int> mounts;
  if (const std::string* list = spec.find("mounts")) {
    for (const std::string& part : parts_of(*list)) {
      const auto mount = parse_integer(part);
      if (!mount) {
        return fail(ErrorCode::usage, "platform.tabletop-magnet: '" + part + "' is no mounting",
                    "mounts=1/2/3, as in the column mount");
      }
      mounts.push_back(static_cast<int>(*mount));
    }
  }
  return std::make_shared<const laws::TabletopMagnet>(std::move(mounts), spec.sensors);
}

template <class E>
Result<EffectPtr> bending(const EffectSpec& spec) {
  if (const auto ok = spec.only({}); !ok) return tl::unexpected(ok.error());
  const auto where = where_of(spec, kSensorScales);
  if (!where) return tl::unexpected(where.error());
  return std::make_shared<const E>(*where);
}

Result<EffectPtr> crosstalk(const EffectSpec& spec) {
  if (const auto ok = spec.only({"baseline"}); !ok) return tl::unexpected(ok.error());
  if (const auto where = where_of(spec, kOwnScale); !where) return tl::unexpected(where.error());
  const auto baseline = spec.number("baseline", 0.4, 0.01, 100);
  if (!baseline) return tl::unexpected(baseline.error());
  return std::make_shared<const Crosstalk>(*baseline);
}

constexpr std::array kCurrentConfusions{
    Confusion{"platform.hard-iron", "a constant current is a hard iron: switch it on and off between poses"},
    Confusion{"axis.offset.temperature", "what draws current also warms: vary one without the other"}};
constexpr std::array kFlexureConfusions{
    Confusion{"axis.transverse", "tilted mountings both ways; stiffen or load the arm"},
    Confusion{"table.wobble", "a turn common to all sensors is the table's: sag differs from arm to arm"}};
constexpr std::array kThermalConfusions{
    Confusion{"axis.orthogonality.temperature", "the three axes of the sensor turn together"},
    Confusion{"axis.gain.temperature", "directions of the field across the turn"}};
constexpr std::array kMagnetConfusions{
    Confusion{"axis.cubic", "more than two mountings"},
    Confusion{"site.gradient", "turn the base of the table: a magnet on the table goes along"}};
constexpr std::array kHardConfusions{Confusion{"platform.current", "switch the currents"}};

constexpr std::array kPlatformFamilies{
    EffectFamily{
        .name = "platform.current",
        .level = Level::platform,
        .title = "the field of currents on the platform",
        .cause = "supplies, motors and cables near the sensors",
        .equation = "b_i += s_i (I - mean of I in the run), for every column that ends in _A",
        .coefficients = "s, nT/A, a vector for each sensor and current",
        .typical = 20,
        .bound = 2000,
        .source = "a single wire 200 nT/A at 1 m, a pair of gap s 200 nT/A s/d^2 (Biot and Savart)",
        .scales = kSensorScales,
        .scan = {},
        .needs = "*_A",
        .signature =
            "follows the current, constant in the platform frame, largest in the sensor near the wire",
        .confusions = kCurrentConfusions,
        .untestable = {},
        .experiment = {},
        .from_spec = &current},
    EffectFamily{
        .name = "platform.flexure",
        .level = Level::platform,
        .title = "the arms of the cross sag",
        .cause = "gravity bends the arms differently in each attitude",
        .equation = "R_i <- exp[omega_i]x R_i, omega_i = S_i g, g = unit gravity in the platform frame",
        .coefficients = "S, deg, 3 x 3 for each sensor",
        .typical = 0.01,
        .bound = 2,
        .source = "0.001 to 0.05 deg on plastic beams of half a metre (estimate); 0.01 deg is 8.7 nT",
        .scales = kSensorScales,
        .scan = {},
        .needs = "azimuth_deg",
        .signature =
            "no scalar residual; sensors turn against each other as the array is tilted. A turn common "
            "to all sensors is held by the table's angles only",
        .confusions = kFlexureConfusions,
        .untestable = {},
        .experiment = {},
        .from_spec = &bending<laws::Flexure>},
    EffectFamily{.name = "platform.thermal-bending",
                 .level = Level::platform,
                 .title = "the cross bends as it warms",
                 .cause = "unequal expansion of beams and mounts",
                 .equation = "R_i <- exp[omega_i]x R_i, omega_i = w_i (T_i - 20 degC)",
                 .coefficients = "w, arcsec/degC, a vector for each sensor",
                 .typical = 5,
                 .bound = 300,
                 .source = "1 to 20 arcsec/degC (estimate); 1 arcsec is 0.24 nT",
                 .scales = kSensorScales,
                 .scan = {},
                 .needs = "T_degC",
                 .signature = "no scalar residual; a sensor turns as a whole with its temperature",
                 .confusions = kThermalConfusions,
                 .untestable = {},
                 .experiment = {},
                 .from_spec = &bending<laws::ThermalBending>},
    EffectFamily{
        .name = "platform.tabletop-magnet",
        .level = Level::platform,
        .title = "something magnetic turns with the table",
        .cause = "a screw or a motor on the turning part; the array is remounted, the magnet stays",
        .equation =
            "b_i += M d_i; the rotation M of a mounting is not recorded, so every mounting after the first "
            "has a vector of its own",
        .coefficients = "m2.s3.x: nT, relative to the first mounting, whose part is in the offsets",
        .typical = 10,
        .bound = 10000,
        .source = "a steel screw of 0.01 A m^2 at 0.2 m: 250 nT",
        .scales = kOwnScale,
        .scan = {},
        .needs = "mount",
        .signature = "offsets that differ from mounting to mounting, largest in the sensor near the magnet",
        .confusions = kMagnetConfusions,
        .untestable = {},
        .experiment = {},
        .from_spec = &tabletop_magnet},
    EffectFamily{
        .name = "platform.hard-iron",
        .level = Level::platform,
        .title = "permanent magnets on the platform",
        .cause = "magnetised screws, connectors, batteries that move with the array",
        .equation = "b_i += h_i",
        .coefficients = "h, nT, a vector for each sensor",
        .typical = 100,
        .bound = 10000,
        .source = "10 to 1000 nT",
        .scales = kOwnScale,
        .scan = {},
        .needs = {},
        .signature = "none: it is part of the offsets",
        .confusions = kHardConfusions,
        .untestable = "a constant field of the platform is exactly an offset of each sensor",
        .experiment = "calibrate with and without the suspect part mounted, and compare with mgt diff",
        .from_spec = &plain<HardIron>},
    EffectFamily{
        .name = "platform.soft-iron",
        .level = Level::platform,
        .title = "iron on the platform",
        .cause = "permeable parts that move with the array and bend the field",
        .equation = "b_i += 1e-6 K_i b_i",
        .coefficients = "K, ppm, 3 x 3 for each sensor",
        .typical = 1000,
        .bound = 100000,
        .source = "1e-4 to 1e-2 of the field",
        .scales = kOwnScale,
        .scan = {},
        .needs = {},
        .signature = "none: it is part of scale factors, angles and alignment",
        .confusions = {},
        .untestable =
            "a field proportional to the field is exactly a change of each sensor's nine matrix parameters",
        .experiment = "calibrate with and without the suspect part mounted, and compare with mgt diff",
        .from_spec = &plain<SoftIron>},
    EffectFamily{
        .name = "platform.crosstalk",
        .level = Level::platform,
        .title = "a sensor feels the feedback field of its neighbours",
        .cause = "outside its coil a compensated head is a dipole as strong as the field it cancels",
        .equation = "b_i += sum over j of D_ij kappa_j b_j, D_ij = (3 n n' - 1)/r^3",
        .coefficients = "kappa, cm^3, one a sensor",
        .typical = 3,
        .bound = 1000,
        .source =
            "about the cube of the coil's radius: 15 mm give 3.4 cm^3, 11 nT at 0.25 m and 1.4 nT at 0.5 m",
        .scales = kOwnScale,
        .scan = {},
        .needs = {},
        .signature = "none in a uniform field: b_j = b_i makes it a soft iron",
        .confusions = {},
        .untestable =
            "in a uniform field all sensors see the same field, and the coupling is part of the matrices",
        .experiment =
            "switch the neighbours off one at a time (twelve runs on and off), or bring a strong gradient",
        .from_spec = &crosstalk},
};

}  // namespace

std::span<const EffectFamily> platform_families() { return kPlatformFamilies; }

}  // namespace mgtd::calib::effects::library
