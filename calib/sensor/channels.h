// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <string>
#include <utility>

#include "proto/reading.h"

/// These types hold the components of all sensors as one vector, sensor by sensor: three of each, twelve of
/// the cross. Sizes are known at run time and bounded at compile time, so that nothing is allocated.
namespace mgtd::calib::sensor {

inline constexpr int kChannels = 3 * kSensors;  ///< of the cross
inline constexpr int kMostChannels = 3 * kMostSensors;
/// A row for each channel.
template <int Columns>
using ChannelRows = Eigen::Matrix<double, Eigen::Dynamic, Columns, Eigen::ColMajor, kMostChannels,
                                  Columns == Eigen::Dynamic ? kMostChannels : Columns>;
/// Corrected components, nT, platform frame.
using FieldVector = ChannelRows<1>;
using ChannelCovariance = ChannelRows<Eigen::Dynamic>;
/// A column for each channel.
template <int Rows>
using ChannelColumns = Eigen::Matrix<double, Rows, Eigen::Dynamic,
                                     Rows == 1 ? Eigen::RowMajor : Eigen::ColMajor, Rows, kMostChannels>;

/// Calls `expression` with the number of rows that take part, as Eigen::fix<Usual> where it is that number,
/// so that its sums are unrolled; `v.head(rows)` and `m.topRows(rows)` take both kinds.
template <int Usual, class Expression>
decltype(auto) over_rows(Eigen::Index rows, Expression&& expression) {
  if (rows == Usual) return expression(Eigen::fix<Usual>);
  return expression(rows);
}
/// Over the channels of an array; twelve is usual.
template <class Expression>
decltype(auto) over_channels(Eigen::Index channels, Expression&& expression) {
  return over_rows<kChannels>(channels, std::forward<Expression>(expression));
}

/// "s2.y" of channel 4.
[[nodiscard]] std::string channel_name(int channel);

}  // namespace mgtd::calib::sensor
