// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>

#include "tests/rig/instrument.h"
#include "tests/rig/world.h"

/// A controller with three rotary axes ("1" azimuth, "2" pitch, "3" roll) that speaks PI GCS 2.0. Set
/// commands are silent; errors wait in a register until ERR? reads and clears it. Bytes 05, 07 and 18 act at
/// once, without a terminator.
namespace mgtd::rig {

class Gcs2Instrument final : public Instrument {
 public:
  explicit Gcs2Instrument(World& world) : world_(world) {}

  void receive(std::string_view bytes, double now_s) override;
  void advance(double now_s) override;
  [[nodiscard]] double next_s() const override { return 1e300; }
  [[nodiscard]] int baud() const override { return 115200; }
  /// Frozen: the table jams where it is and still says it moves.
  void set_frozen(bool frozen) override {
    jam_pending_ = frozen;
    frozen_ = frozen;
  }

 private:
  struct Axis {
    bool servo{false};
    bool referenced{false};
    double reference_done_s{-1};  ///< a reference move ends then
  };

  void immediate(char byte, double now_s);
  void command(std::string_view line, double now_s);
  void set(std::string_view verb, std::string_view rest, double now_s);
  void query(std::string_view verb, std::string_view rest, double now_s);
  void move(std::size_t axis, double target_deg, double now_s);
  void stop_all(double now_s);
  [[nodiscard]] bool referencing(double now_s) const;
  [[nodiscard]] double limit_deg(std::size_t axis) const;
  /// Index of the named axis; sets error 15 when there is none.
  [[nodiscard]] int axis_named(std::string_view name);

  World& world_;
  std::array<Axis, 3> axes_;
  std::string line_;
  int error_{0};
  bool jam_pending_{false};
};

}  // namespace mgtd::rig
