// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/place.h"

#include "calib/discovery/channel_sums.h"
#include "calib/effects/where.h"

namespace mgtd::calib::discovery {

std::string Place::name() const {
  switch (kind) {
    case Kind::axis:
      return effects::axis_name(at / 3, at % 3);
    case Kind::sensor:
      return effects::sensor_name(at);
    case Kind::array:
      return "each-axis";
    case Kind::gradient:
      return "site gradient";
  }
  return {};
}

std::vector<int> Place::channels(int of_readings) const {
  int first = 0, count = of_readings;
  if (kind == Kind::axis) first = at, count = 1;
  if (kind == Kind::sensor) first = 3 * at, count = 3;
  if (kind == Kind::gradient) first = of_readings, count = kGradient;
  std::vector<int> out;
  for (int c = first; c < first + count; ++c) out.push_back(c);
  return out;
}

int Place::alike(int channels) const {
  return kind == Kind::axis ? channels : kind == Kind::sensor ? channels / 3 : 1;
}

std::vector<Place> places(int channels, bool gradient) {
  std::vector<Place> out;
  for (int c = 0; c < channels; ++c) out.push_back({Place::Kind::axis, c});
  for (int s = 0; s < channels / 3; ++s) out.push_back({Place::Kind::sensor, s});
  if (channels > 3) out.push_back({Place::Kind::array, 0});
  if (gradient) out.push_back({Place::Kind::gradient, 0});
  return out;
}

}  // namespace mgtd::calib::discovery
