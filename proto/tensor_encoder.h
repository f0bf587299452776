// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>

#include "proto/input_value.h"
#include "proto/tensor.h"

/// A TensorEncoder writes a TensorSample as one TENSOR line of the live stream, without the line end:
///
///   {"class":"TENSOR","seq":123,"t":"2026-11-21T10:00:00.123456Z","t_ns":1795255200123456000,
///    "frame":"platform","cal":"c0123456789ab","b_nT":[..3..],"f_nT":..,
///    "g_nT_per_m":{"xx":..,"yy":..,"zz":..,"xy":..,"xz":..,"yz":..},"g_sd_nT_per_m":{same keys},
///    "invariants":{"I1_nT2_per_m2":..,"I2_nT3_per_m3":..,"contraction_nT_per_m":..} or null,
///    "closure":{"curl_nT_per_m":..,"center_nT":[..3..],"chi2":..},"flags":["interpolated"],
///    "inputs":{"motor_A":0.731250}}
///
/// Of an array that is no cross the closure is
///    {"curl_nT_per_m":null,"center_nT":null,"chi2":..,"dof":3N-8,"combinations_nT":[..3N-8..]}
/// and sensors on one line have, before it, the derivative of the field along that line
///    "along_line_nT_per_m":[..3..],"along_line_sd_nT_per_m":[..3..]
///
/// `t` and `t_ns` are the same instant, UTC. What is not a finite number is null; so is `cal` without a
/// calibration. Numbers carry six decimals, 1 fT and 1 fT/m, far below what any fluxgate resolves; `zz` is
/// printed as minus the sum of the printed `xx` and `yy`, so that rounding leaves the trace zero.
/// `inputs`, what the rig measures beside the field, is there when it has any. No allocation once the buffer
/// has grown to a line's length. Not for concurrent use.
namespace mgtd {

class TensorEncoder {
 public:
  /// The view is valid until the next call.
  [[nodiscard]] std::string_view encode(const TensorSample& sample, std::span<const InputValue> inputs = {});

 private:
  void append_time(WallTime t);

  std::string line_;
  std::int64_t second_{std::numeric_limits<std::int64_t>::min()};  ///< the one written in second_text_
  std::string second_text_;                                        ///< "2026-11-21T10:00:00."
};

}  // namespace mgtd
