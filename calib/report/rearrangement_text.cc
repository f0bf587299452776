// SPDX-License-Identifier: Apache-2.0
#include "calib/report/rearrangement_text.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cstddef>
#include <numbers>

namespace mgtd::calib::report {
namespace {

std::string quarter_turn_text(const Eigen::Matrix3d& turn_P) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const int deg : {90, 180, -90}) {
      const Eigen::AngleAxisd by(deg * std::numbers::pi / 180, Eigen::Vector3d::Unit(axis));
      if ((turn_P - by.toRotationMatrix()).norm() < 1e-9)
        return fmt::format("by {} deg about {}", deg, "XYZ"[axis]);
    }
  }
  std::string out = "so that what pointed along X, Y, Z now points along ";
  for (int column = 0; column < 3; ++column) {
    Eigen::Index row = 0;
    turn_P.col(column).cwiseAbs().maxCoeff(&row);
    out += fmt::format("{}{}{}", column > 0 ? ", " : "", turn_P(row, column) < 0 ? "-" : "+", "XYZ"[row]);
  }
  return out;
}

}  // namespace

std::string rearrangement_text(const criticism::tests::Rearrangement& what) {
  if (what.turned) return fmt::format("s{} is turned {}", *what.turned + 1, quarter_turn_text(what.turn_P));
  std::string out;
  for (std::size_t place = 0; place < what.sensor.size(); ++place) {
    const std::size_t whose = what.sensor.at(place);
    if (whose == place) continue;
    const bool pair = what.sensor.at(whose) == place;
    if (pair && whose < place) continue;
    out += out.empty() ? "" : ", ";
    out += pair ? fmt::format("s{} and s{} are exchanged", place + 1, whose + 1)
                : fmt::format("s{} reads what s{} should", place + 1, whose + 1);
  }
  return out;
}

std::string rearrangement_text(const std::vector<criticism::tests::Rearrangement>& possible) {
  std::string out;
  for (const criticism::tests::Rearrangement& what : possible)
    out += (out.empty() ? "" : ", or ") + rearrangement_text(what);
  return out;
}

std::string exchange_text(const criticism::tests::ExchangeInRun& found) {
  return fmt::format(
      "{} from pose {} on: taken so, the total field of the sensors fits to {:.2g} nT, as it stands to "
      "{:.3g} "
      "nT; swap the plugs back and measure again",
      rearrangement_text(found.what), found.from_pose, found.residual_nT, found.without_nT);
}

}  // namespace mgtd::calib::report
