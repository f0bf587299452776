// SPDX-License-Identifier: Apache-2.0
#include "tests/blind/real_draw.h"

#include <fmt/format.h>

#include <cmath>

namespace mgtd::calib::testing {

double between(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}
double sign(Random& random) { return random() % 2 == 0 ? 1 : -1; }

std::vector<double> direction(Random& random, std::size_t count, double length) {
  std::normal_distribution<double> normal;
  std::vector<double> out(count);
  double square = 0;
  for (double& v : out) {
    v = normal(random);
    square += v * v;
  }
  for (double& v : out) v *= length / std::sqrt(square);
  return out;
}
std::array<double, 3> vector(Random& random, double length) {
  const auto v = direction(random, 3, length);
  return {v[0], v[1], v[2]};
}

std::string sensor_at_random(Random& random) { return fmt::format("s{}", 1 + random() % 4); }
std::string axis_at_random(Random& random) {
  const std::string sensor = sensor_at_random(random);
  return fmt::format("{}.{}", sensor, "xyz"[random() % 3]);
}

Planted dipole_at_random(Random& random) {
  const auto moment = vector(random, 3), at = vector(random, between(random, 1, 2));
  return {"site.dipole", "all", {moment[0], moment[1], moment[2], at[0], at[1], at[2]}};
}

}  // namespace mgtd::calib::testing
