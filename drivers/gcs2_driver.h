// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/gcs2_settings.h"
#include "drivers/line_device.h"
#include "drivers/query_queue.h"

/// A Gcs2Driver runs a turntable of one to three axes through a GCS 2 controller.
///
///   opening  stop (18), identity, axes checked, travel read, velocity set, servo off; then live
///   home     per axis not yet referenced: servo on, FRF, 07 until ready, FRF?
///   move     servo on, MOV per axis, then 05, ONT?, POS? every 0.1 s until all stand on target; servo off
///   idle     05 and POS? every second
///
/// ERR? follows every set command; an error is a DeviceFault in words and stops the table. A move that takes
/// longer than distance/velocity*2 + 10 s is stopped. limits() is what the controller allows and the
/// configuration narrows; before the controller was asked, it is the configuration's, or no travel at all.
/// A controller that stopped answering, or that answers late, is not believed until the line is proved again
/// (query_queue.h), by *IDN?, POS? and byte 05, whose replies cannot be taken for one another. A command
/// whose error was not told is sent again.
///
/// on_target holds from arrival until the next request (with the servo off the controller no longer says it);
/// a table that turns meanwhile is a fault.
///
/// Does not plan a path: all axes start together, each at the set velocity.
namespace mgtd::drivers::gcs2 {

class Gcs2Driver final : public LineBased<Turntable> {
 public:
  explicit Gcs2Driver(Gcs2Settings settings);
  [[nodiscard]] static std::unique_ptr<Device> make(int slot, Settings& settings);

  void on_open(Stamp now) override;
  void on_tick(Stamp now) override;
  void on_close(Stamp now) override;

  void home() override;
  void move_to(TableAngles target) override;
  void stop() override;
  [[nodiscard]] const TableLimits& limits() const override { return limits_; }

 protected:
  FrameResult on_line(std::string_view line, Stamp arrival) override;

 private:
  enum class Phase { closed, starting, ready, waiting };
  enum class Job { none, homing, moving, arriving };
  enum class Ask {
    error,
    stop_error,
    identity,
    axes,
    travel_min,
    travel_max,
    referenced,
    ready,
    moving,
    on_target,
    position
  };
  struct Axis {
    AxisSettings settings;
    double travel_min_deg{0}, travel_max_deg{0};
    double position_deg{0}, target_deg{0};
    bool referenced{false}, on_target{false};
  };
  /// The move, or the way home, that the table is on or was last.
  struct Move {
    double longest_s{0};           ///< that it may take
    bool overdue{false};           ///< it took longer ...
    bool asked_overdue{false};     ///< ... and the poll under way was begun after that
    bool cycle_is_of_it{false};    ///< a poll begun before the move says nothing about it
    std::uint32_t axes_moving{0};  ///< a bit each, as byte 05 answers
    bool arrived{false};
  };
  using Question = Query<Ask>;

  void start();
  void pump();
  void set(const std::string& command);
  void ask(Ask what, std::string send, std::string_view form);
  void ask_value(Ask what, std::string_view mnemonic, std::size_t axis);
  void servo(bool on);
  void ask_cycle();
  void poll();
  void begin_wanted();
  void begin_home();
  void reference_next();
  void begin_move(const TableAngles& target);
  void limit_job(double seconds);
  [[nodiscard]] bool refuse_target(const TableAngles& target);
  void arrive();
  void end_of_cycle();
  void took_too_long();
  void check_dwell();
  void halt();

  [[nodiscard]] bool take(const Question& question, std::string_view line);
  [[nodiscard]] bool take_error(const Question& question, std::string_view line);
  [[nodiscard]] bool take_start_up(const Question& question, std::string_view line);
  [[nodiscard]] bool take_state(const Question& question, std::string_view line);
  void on_axes(const std::vector<std::string>& present);
  void on_referenced(Axis& axis, bool yes);
  void narrow_limits(const Axis& axis);

  void fault(std::string what, std::string remedy);
  void give_up(const std::string& asked);
  void fail_start(std::string what, std::string remedy);
  void report(bool moving);
  [[nodiscard]] bool all_referenced() const;
  [[nodiscard]] TableAngles angles() const;
  [[nodiscard]] bool busy() const { return job_ != Job::none || move_.axes_moving != 0; }

  Gcs2Settings settings_;
  std::vector<Axis> axes_;
  TableLimits limits_;
  Phase phase_{Phase::closed};
  Job job_{Job::none};
  QueryQueue<Ask> queue_;
  Stamp now_;
  Instant next_poll_{};
  Deadline job_deadline_, retry_;
  bool wants_home_{false};
  std::optional<TableAngles> wanted_;
  std::size_t homing_axis_{0};
  Move move_;
  std::string last_start_fault_;
  std::string strange_;  ///< the last line that answered nothing, since an answer came
};

}  // namespace mgtd::drivers::gcs2
