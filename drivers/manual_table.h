// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>

#include "drivers/device.h"
#include "drivers/settings.h"

/// A table without motors or encoders stands where the operator last said that its scales stand. Has no port;
/// moves are the operator's, who is asked by the run.
///
///   limits.azimuth = [-180, 180]   deg; likewise pitch and roll; an axis that is not there has no limits
namespace mgtd::drivers {

class ManualTable final : public Turntable {
 public:
  explicit ManualTable(TableLimits limits) : limits_(limits) {}
  static std::unique_ptr<Device> make(int slot, Settings& settings);

  void on_open(Stamp now) override;
  void on_bytes(std::span<const std::byte>, Stamp) override {}
  void on_tick(Stamp now) override;
  void on_close(Stamp now) override;
  [[nodiscard]] int baud() const override { return 0; }

  /// Nothing to search for: the scales have their zero.
  void home() override { referenced_ = true; }
  /// A hand is no motor: refused.
  void move_to(TableAngles target) override;
  void stop() override {}
  [[nodiscard]] const TableLimits& limits() const override { return limits_; }

  void set(const TableAngles& scales);

 private:
  void say(Stamp now);

  TableLimits limits_;
  TableAngles at_;
  bool referenced_{false}, known_{false};
  Stamp now_;
  std::optional<Instant> last_said_;
};

}  // namespace mgtd::drivers
