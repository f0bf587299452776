// SPDX-License-Identifier: Apache-2.0
#pragma once

/// An AzimuthOrigin says where the azimuth of the platform frame comes from in a two-step calibration.
namespace mgtd::calib::fit {

enum class AzimuthGauge { declination_given, table_frame, mean_gamma_zero };

struct AzimuthOrigin {
  AzimuthGauge gauge{AzimuthGauge::mean_gamma_zero};
  double declination_rad{0};
  /// Rms angle between where the tilted poses put the field and where it was; 0 without such poses. A large
  /// angle means that a table angle has the wrong sense.
  double misfit_rad{0};
};

}  // namespace mgtd::calib::fit
