// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "calib/sensor/sensor_model.h"
#include "tests/support/paper_rigs.h"

/// A campaign is many simulated runs of one rig; it shows whether the estimate is as good as it can be and
/// its uncertainty the real one.
namespace mgtd::testing {

/// xx yy zz xy xz yz, nT/m.
using Components = Eigen::Array<double, 6, 1>;

/// What is simulated. Runs differ in attitudes, noise, table errors and scalar errors.
struct Scene {
  RigTruth rig{table6_rig()};
  Site site{.f_nT = 53'907.7};
  std::size_t poses{157};
  double noise_nT{1}, table_sd_deg{0.1}, f_sd_nT{0.05};
  bool gradient{false};  ///< up to 50 nT/m at the site, and in the model
  bool spreads{false};   ///< the poses say how their samples scattered; else the residuals must tell

  [[nodiscard]] PoseTable run(std::uint64_t seed) const;
};

/// Error of the tensor on clean attitudes: what the calibration alone does, rms over seeds and attitudes.
struct TensorErrors {
  Components two_step{Components::Zero()}, joint{Components::Zero()};
  Components bound{Components::Zero()};  ///< Cramer-Rao, at the truth, of the same poses
  int seeds{0};
};
[[nodiscard]] TensorErrors tensor_errors(const Scene& scene, int seeds);
/// Of one calibration: mean square over the same clean attitudes.
[[nodiscard]] Components tensor_mean_square(const PerSensor<calib::sensor::SensorModel>& estimate,
                                            const Scene& scene);

/// Reported covariance against real errors.
struct Consistency {
  int runs{0};
  double nees{0};                    ///< mean of the normalised estimation error squared
  double unknowns{0};                ///< its expectation
  double band_low{0}, band_high{0};  ///< 99.9 % of such means
  int intervals{0};
  double covered{0};        ///< share of the 95 % intervals that hold the truth
  double worst_covered{1};  ///< of a single parameter over the runs
  std::string worst;        ///< which one
};
[[nodiscard]] Consistency consistency(const Scene& scene, int runs);

/// The sensors as calib knows them.
[[nodiscard]] PerSensor<calib::sensor::SensorModel> models_of(const RigTruth& rig);

}  // namespace mgtd::testing
