// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <optional>
#include <random>
#include <vector>

#include "tests/rig/instrument.h"
#include "tests/rig/world.h"

/// This simulates a controller with three rotary axes ("1" azimuth, "2" pitch, "3" roll) that speaks PI GCS
/// 2.0. Set commands are silent; errors wait in a register until ERR? reads and clears it. Bytes 05, 07 and
/// 18 act at once, without a terminator. A command with a mistake in it does nothing at all.
///
/// Known: *IDN? SAI? ERR? SVO SVO? FRF FRF? MOV MOV? POS? ONT? VEL VEL? TMN? TMX? HLT STP.
namespace mgtd::rig {

class Gcs2Instrument final : public Instrument {
 public:
  explicit Gcs2Instrument(World& world);

  void receive(std::string_view bytes, double now_s) override;
  void advance(double now_s) override;
  [[nodiscard]] double next_s() const override;
  [[nodiscard]] int baud() const override { return 115200; }
  /// Its axes turn the wrong way, and it says that they are where they should be.
  void set_backwards(bool backwards) { backwards_ = backwards; }
  /// Every motion meets a limit switch, which takes the servo away.
  void set_at_limit(bool at_limit) { at_limit_ = at_limit; }

 protected:
  void switched_off(double now_s) override;

 private:
  struct Axis {
    bool servo{false};
    bool referenced{false};
    double target_deg{0};
    double reference_done_s{-1};  ///< a reference move ends then
  };
  struct Assignment {
    std::size_t axis;
    double value;
  };

  void immediate(char byte, double now_s);
  void command(std::string_view line, double now_s);
  void query(std::string_view verb, std::string_view rest, double now_s);
  [[nodiscard]] std::optional<std::string> answer(std::string_view verb, std::size_t axis, double now_s);
  void reference(std::string_view rest, double now_s);
  void assign(std::string_view verb, std::string_view rest, double now_s);
  [[nodiscard]] int refusal(std::string_view verb, const Assignment& wanted) const;
  void carry_out(std::string_view verb, const Assignment& wanted, double now_s);
  void stop(const std::vector<std::size_t>& axes, double now_s);
  void meet_limit(double now_s);
  [[nodiscard]] bool busy(std::size_t axis, double now_s) const;
  [[nodiscard]] double limit_deg(std::size_t axis) const;
  /// The named axes, all of them when none is; sets the error when one does not exist.
  [[nodiscard]] std::optional<std::vector<std::size_t>> axes_named(std::string_view names);

  World& world_;
  std::array<Axis, 3> axes_;
  std::mt19937_64 random_;
  std::normal_distribution<double> encoder_;
  std::string line_;
  int error_{0};
  bool jammed_{false}, backwards_{false}, at_limit_{false};
};

}  // namespace mgtd::rig
