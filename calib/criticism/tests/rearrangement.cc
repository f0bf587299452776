// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/rearrangement.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "calib/criticism/tests/possible_exchanges.h"
#include "calib/stats/chi_square.h"

namespace mgtd::calib::criticism::tests {
namespace {

constexpr double kOthersAgree = 0.02, kStandsOut = 0.1;  // of the field
constexpr int kAgree = 10;

/// The 24 turns by quarters.
const std::vector<Eigen::Matrix3d>& quarter_turns() {
  static const std::vector<Eigen::Matrix3d> kAll = [] {
    std::vector<Eigen::Matrix3d> all;
    std::array<int, 3> axis{0, 1, 2};
    do {
      for (int signs = 0; signs < 8; ++signs) {
        Eigen::Matrix3d turn = Eigen::Matrix3d::Zero();
        for (int row = 0; row < 3; ++row)
          turn(row, axis.at(static_cast<std::size_t>(row))) = (signs >> row) % 2 == 0 ? 1 : -1;
        if (turn.determinant() > 0) all.push_back(turn);
      }
    } while (std::next_permutation(axis.begin(), axis.end()));
    return all;
  }();
  return kAll;
}

bool same(const Rearrangement& a, const Rearrangement& b) {
  return a.sensor == b.sensor && a.turned == b.turned && a.turn_P == b.turn_P;
}

}  // namespace

double explained_closure_chi2(int dof) { return stats::chi_square_alike(30, 4, dof); }

std::vector<Rearrangement> exchanges_explaining(const calibration::TensorPipeline& pipeline,
                                                const Epoch& epoch) {
  std::vector<Rearrangement> out;
  const double limit = explained_closure_chi2(pipeline.closure_dof());
  Epoch given = epoch;
  for (const PerSensor<std::size_t>& sensor : possible_exchanges(epoch.y_nT.size())) {
    // What comes in a place is given to the sensor whose it is.
    for (std::size_t place = 0; place < sensor.size(); ++place) {
      given.y_nT.at(sensor.at(place)) = epoch.y_nT.at(place);
      given.T_degC.at(sensor.at(place)) = epoch.T_degC.at(place);
    }
    if (pipeline.apply(given).closure.chi2 < limit) out.push_back({.sensor = sensor});
  }
  return out;
}

std::vector<Rearrangement> turns_explaining(const calibration::TensorPipeline& pipeline, const Epoch& epoch) {
  const sensor::FieldVector b_P_nT = pipeline.correct(epoch.y_nT);
  const std::size_t sensors = epoch.y_nT.size();
  PerSensor<std::size_t> in_place(sensors);
  std::iota(in_place.begin(), in_place.end(), std::size_t{0});
  std::vector<Rearrangement> out;
  for (std::size_t sensor = 0; sensors > 2 && sensor < sensors; ++sensor) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < sensors; ++i)
      if (i != sensor)
        mean += b_P_nT.segment<3>(3 * static_cast<Eigen::Index>(i)) / static_cast<double>(sensors - 1);
    double apart = 0;
    for (std::size_t i = 0; i < sensors; ++i)
      if (i != sensor)
        apart = std::max(apart, (b_P_nT.segment<3>(3 * static_cast<Eigen::Index>(i)) - mean).norm());
    const Eigen::Vector3d own = b_P_nT.segment<3>(3 * static_cast<Eigen::Index>(sensor));
    const double f_nT = mean.norm();
    if (apart > kOthersAgree * f_nT || (own - mean).norm() < kStandsOut * f_nT) continue;
    for (const Eigen::Matrix3d& turn : quarter_turns())
      if ((turn * own - mean).norm() < kTurnAgreement * f_nT)
        out.push_back({.sensor = in_place, .turned = sensor, .turn_P = turn});
  }
  return out;
}

RearrangementWatch::RearrangementWatch(const std::shared_ptr<const calibration::Calibration>& calibration)
    : pipeline_(calibration::TensorPipeline(calibration)) {}

void RearrangementWatch::add(const Epoch& epoch, std::optional<bool> beyond) {
  if (!pipeline_ || !beyond) return;
  if (*beyond) {
    calm_ = 0;
    explain(epoch);
  } else if (++calm_ >= kAgree) {
    finding_.reset();
    possible_.clear();
    explained_ = 0;
  }
}

void RearrangementWatch::explain(const Epoch& epoch) {
  std::vector<Rearrangement> found = exchanges_explaining(*pipeline_, epoch);
  if (found.empty()) found = turns_explaining(*pipeline_, epoch);
  if (explained_ > 0) {
    std::erase_if(found, [this](const Rearrangement& f) {
      return std::none_of(possible_.begin(), possible_.end(),
                          [&](const Rearrangement& before) { return same(f, before); });
    });
  }
  const bool fewer = found.size() != possible_.size();
  possible_ = std::move(found);
  if (possible_.empty()) {
    explained_ = 0;
    finding_.reset();
    return;
  }
  if (++explained_ == kAgree || (explained_ > kAgree && fewer)) conclude(epoch);
}

void RearrangementWatch::conclude(const Epoch& epoch) {
  finding_ = {possible_, pipeline_->apply(epoch).closure.chi2, pipeline_->closure_dof()};
}

}  // namespace mgtd::calib::criticism::tests
