// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <functional>
#include <string>
#include <vector>

#include "calib/discovery/law_inputs.h"

/// The grammar is every formula that a search tries. It is fixed before a residual is seen: its size and hash
/// stand beside the probability of what was found.
///
///     a scalar u       powers 2 to 4 and size about its mean, {u, u2}, steps and hinges at nine deciles; u
///     is
///                      time, the sensor's temperature, another's, any column that varies, the table's
///                      angles, the parity of the pose
///     time             sqrt, exp(-t/tau), one period
///     temperature      behind a low-pass; its slope; both
///     angles           harmonics 1 to 6; components of gravity in the platform's frame
///     own readings     powers, size, sign, x|x|, tanh, hinges, products of two and three axes
///     the pose before  its reading, size, square, sign, product with this one
///     products         of two scalars or harmonics; T2 t, T t2, low-pass of T times t
///     gains            reading times a scalar, its square, slope, low-pass, hinge, step, decay, harmonic,
///                      oscillation; other axes times a scalar; |x|, x2 times a scalar
///     neighbours       size, powers, sign of a reading of another sensor, and reading times its temperature
///
/// What is linear in the field, and a constant, is a parameter of the calibration already. The number that a
/// formula has inside (a time constant, a knot) is tried at the values of a grid. Products are tried with
/// each factor about its mean and about zero (20 degC). A symbol is a name, a number or an operation; a law
/// that reads another sensor counts one more.
namespace mgtd::calib::discovery {

/// Expressions that are summed, each with a coefficient of its own; as `mgt define` takes them.
using Columns = std::vector<std::string>;

/// Unit gravity in the platform's frame, x, y, z, by the angles of the table: the last column of its rotation
/// (sensor/sensor_equations.h).
inline const std::array<std::string, 3> kGravity{
    "(sind(azimuth_deg)*sind(roll_deg)-cosd(azimuth_deg)*sind(pitch_deg)*cosd(roll_deg))",
    "(cosd(azimuth_deg)*sind(roll_deg)+sind(azimuth_deg)*sind(pitch_deg)*cosd(roll_deg))",
    "(cosd(pitch_deg)*cosd(roll_deg))"};

struct Family {
  std::vector<std::string>
      covariates;  ///< names it depends on, without what was before: "T_degC", "t_h", "u"
  int symbols{1};
  /// Grid of the inner number; one value that nobody reads where there is none.
  std::vector<double> inner{0};
  std::string inner_unit{};  ///< "s", "h", ...
  std::function<Columns(double inner)> columns;
  bool whole_array{true};  ///< is tried on all axes together too
  bool of_site{true};      ///< is tried as a gradient of the site's field, where it is common
  int foreign_sensor{-1};  ///< it reads what another sensor has, and is not tried on that sensor
  int foreign_axis{-1};    ///< it reads ux, uy or uz, and is not tried where that is the axis itself
  bool common{true};       ///< the same values on every channel
  bool refined{false};     ///< between two values of the grid lie others
};

struct Grammar {
  std::vector<Family> families;
  [[nodiscard]] std::size_t members() const;  ///< with every value of the inner numbers
  [[nodiscard]] std::string hash() const;     ///< eight characters, of every expression
};

[[nodiscard]] Grammar grammar(const LawInputs& inputs);

}  // namespace mgtd::calib::discovery
