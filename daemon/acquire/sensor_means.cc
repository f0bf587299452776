// SPDX-License-Identifier: Apache-2.0
#include "daemon/acquire/sensor_means.h"

#include <cmath>

namespace mgtd::daemon::acquire {

void SensorMeans::add(const Epoch& epoch, const std::shared_ptr<const std::string>& calibration,
                      const calib::sensor::FieldVector& fields_P_nT,
                      const std::optional<TableAngles>& table) {
  if (!begun_) {
    *this = SensorMeans();
    begun_ = true;
    from_seq_ = epoch.seq;
    calibration_ = calibration;
    sums_ = PerSensor<Sums>(epoch.y_nT.size());
  }
  to_seq_ = epoch.seq;
  t_ = epoch.t.wall;
  T_degC_ = epoch.T_degC;
  one_calibration_ = one_calibration_ && calibration != nullptr && calibration == calibration_;
  calibration_ = calibration;
  stands_ = stands_ && table.has_value();
  table_ = table;
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    if (!epoch.y_nT[i].allFinite()) continue;
    Sums& s = sums_[i];
    const bool first = s.epochs++ == 0;
    if (first) s.first_nT = epoch.y_nT[i];
    const Eigen::Vector3d difference_nT = epoch.y_nT[i] - s.first_nT;
    s.sum_nT += difference_nT;
    s.squares_nT2 += difference_nT.cwiseAbs2();
    if (!one_calibration_) continue;
    const Eigen::Vector3d b_P_nT = fields_P_nT.segment<3>(3 * static_cast<Eigen::Index>(i));
    if (first) s.first_P_nT = b_P_nT;
    s.sum_P_nT += b_P_nT - s.first_P_nT;
  }
}

std::optional<SensorsReport> SensorMeans::take() {
  if (!begun_) return std::nullopt;
  begun_ = false;
  SensorsReport out{.from_seq = from_seq_, .to_seq = to_seq_, .t = t_, .sensors = PerSensor<SensorMean>(0)};
  if (calibration_ != nullptr) out.calibration = *calibration_;
  if (stands_) out.table = table_;
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    const Sums& s = sums_[i];
    SensorMean& mean = out.sensors.emplace_back();
    mean.epochs = s.epochs;
    mean.T_degC = T_degC_[i];
    if (s.epochs == 0) continue;
    const auto n = static_cast<double>(s.epochs);
    mean.y_nT = s.first_nT + s.sum_nT / n;
    if (s.epochs > 1)
      mean.sd_nT = ((s.squares_nT2 - s.sum_nT.cwiseAbs2() / n) / (n - 1)).cwiseMax(0).cwiseSqrt();
    if (one_calibration_) mean.b_P_nT = s.first_P_nT + s.sum_P_nT / n;
  }
  return out;
}

}  // namespace mgtd::daemon::acquire
