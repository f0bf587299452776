// SPDX-License-Identifier: Apache-2.0
#include "proto/tensor.h"

#include <Eigen/LU>

namespace mgtd {

std::optional<Invariants> invariants(const Gradient& g) {
  Eigen::Matrix3d G;
  G << g.xx, g.xy, g.xz,  //
      g.xy, g.yy, g.yz,   //
      g.xz, g.yz, g.zz;
  if (!G.allFinite()) return std::nullopt;
  const double I1 = g.xx * g.yy + g.yy * g.zz + g.xx * g.zz - g.xy * g.xy - g.yz * g.yz - g.xz * g.xz;
  return Invariants{I1, G.determinant(), G.norm()};
}

}  // namespace mgtd
