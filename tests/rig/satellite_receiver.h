// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "tests/rig/instrument.h"

/// A satellite receiver has no business on any port of this rig: it talks once a second, at the right speed,
/// in lines that are none of the instruments', and does not listen.
namespace mgtd::rig {

class SatelliteReceiver final : public Instrument {
 public:
  explicit SatelliteReceiver(int baud) : baud_(baud) {}

  void receive(std::string_view /*bytes*/, double /*now_s*/) override {}
  void advance(double now_s) override {
    for (; next_s_ <= now_s; next_s_ += 1)
      put("$GPGGA,100000.00,4717.11,N,00833.91,E,1,08,1.01,499.6,M,48.0,M,,*5B\r\n", next_s_);
  }
  [[nodiscard]] double next_s() const override { return next_s_; }
  [[nodiscard]] int baud() const override { return baud_; }

 private:
  int baud_;
  double next_s_{0.1};
};

}  // namespace mgtd::rig
