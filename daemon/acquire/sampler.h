// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "daemon/acquire/clock_model.h"
#include "daemon/acquire/stuck_sensor.h"
#include "proto/epoch.h"
#include "proto/reading.h"
#include "proto/time.h"

/// The Sampler turns free-running streams of readings, one for each sensor, into epochs on one clock.
///
/// The grid is the samples of the reference sensor (s1). Each other sensor is interpolated linearly between
/// its two real neighbouring samples, on sample times from its own clock model; where it lies closer to one
/// sample than matters, that sample is taken as it is. Interpolation halves white noise at worst (weights f,
/// 1-f) and correlates neighbours. An epoch leaves with the last sample it needs. Where a needed sample was
/// lost, rejected or never came, the epoch is a Gap that says whose and why: nothing is extrapolated, nothing
/// bridged. Epochs and gaps tile the sequence without hole or overlap.
///
/// Each sample gets a number in its stream, and by it a time. Where it carries the device's own time, that
/// decides; else the count of the driver, held against the time of arrival. Where the two disagree (frames
/// lost before anybody saw them, damage that looks like more or fewer frames, a line behind in its
/// deliveries) the number is in doubt until a sample proves it: the epochs are flagged clock_unsettled and
/// the doubt is part of their bound. A sample that comes twice, or after its successor, is dropped.
///
/// skew_bound_s: the most by which two of the samples may differ in true time, from how early and how late
/// each clock model allows its sample to be, and the shift left uninterpolated. Constant delays (filter group
/// delay, wire time) must be configured; no software sees them.
namespace mgtd::daemon::acquire {

struct SamplerConfig {
  double rate_hz{50};
  // One a sensor; how many there are is how many sensors the array has.
  PerSensor<double> latency_s{};  ///< sample instant to first byte: filter group delay, conversion
  PerSensor<double> wire_s{};     ///< first to last byte of the shortest frame: bytes x 10 / baud
  /// A sensor that sent nothing for so long is silent; multiply by a simulation's speed-up.
  double silence_s{1.0};
  PerSensor<double> step_s{0.016, 0.016, 0.016, 0.016};  ///< longest step of each delivery timer
  double scheduling_s{0.5e-3};                           ///< of the host, beside them
  double max_drift{0.12};                                ///< of a device's rate against rate_hz, relative
  std::uint64_t settle_samples{100};
  double temperature_s{300};      ///< a temperature is attached to epochs for so long
  std::uint64_t first_seq{0};     ///< number of the first epoch
  double negligible_shift{2e-3};  ///< of a period: no interpolation below it
};

/// Time that bytes need on a line with one start and one stop bit, s.
[[nodiscard]] constexpr double wire_s(std::size_t bytes, int baud) {
  constexpr double kBitsPerByte = 10;
  return baud > 0 ? kBitsPerByte * static_cast<double>(bytes) / baud : 0;
}

struct SensorStreamHealth {
  std::uint64_t samples{0};
  std::uint64_t lost{0};          ///< frames missing in the device's own count, or found missing by time
  std::uint64_t duplicates{0};    ///< dropped: came twice, or after its successor
  std::uint64_t reopened{0};      ///< counter restarted
  std::uint64_t clock_breaks{0};  ///< the sample times jumped against the host clock; the model starts over
  std::uint64_t gaps{0};          ///< epochs not measured because of this sensor
  ClockState clock;
};

struct SamplerHealth {
  std::uint64_t epochs{0};
  std::uint64_t gaps{0};  ///< epochs not measured
  PerSensor<SensorStreamHealth> sensors;
};

class Sampler {
 public:
  explicit Sampler(SamplerConfig config);

  /// Appends to `out` whatever became complete. Readings of one sensor come in order of arrival.
  void push(const FieldReading& reading, std::vector<EpochOrGap>& out);
  /// Remembered and attached to later epochs, as long as it is not too old.
  void push(const TemperatureReading& reading);
  /// The device was opened again: its counter and clock start over, its epochs continue in time.
  void reopened(int slot);
  /// Time passes: epochs whose samples can no longer come become gaps. Call every 20-50 ms.
  void advance(Instant now, std::vector<EpochOrGap>& out);

  [[nodiscard]] SamplerHealth health() const;
  /// Number of the next epoch.
  [[nodiscard]] std::uint64_t next_seq() const { return next_seq_; }

 private:
  struct Sample {
    std::int64_t k{-1};
    double arrival_s{0};
    Eigen::Vector3d y_nT;
    Flags flags;
    double doubt_s{0};  ///< by which its time may be wrong as long as its number is not proved
    double late_s{0};   ///< later than usual by so much: delivery, or frames lost unseen before it
  };
  /// Samples that all come more than a period late: frames were lost unseen, or delivery stalls.
  struct Lateness {
    std::uint64_t samples{0};
    std::int64_t first_k{0};
    double since_s{0}, least_s{0}, span_s{0};
  };
  /// By how much a number rises, and how many of that may not have been.
  struct Step {
    std::int64_t by{0}, doubtful{0};
  };
  struct Stream {
    Stream(ClockModel model, std::size_t capacity) : clock(std::move(model)), ring(capacity) {}

    ClockModel clock;
    StuckSensor repeats;
    std::vector<Sample> ring;  ///< by k modulo its size, a power of two
    std::int64_t first_k{0};   ///< of this opening
    std::int64_t last_k{-1};
    double last_arrival_s{0};          ///< or when the sampler began
    std::optional<FieldReading> last;  ///< empty after reopening
    Lateness late;
    std::int64_t inserted{0};  ///< numbers given to frames counted lost and not yet confirmed by time
    std::int64_t inserted_at{0};
    std::int64_t doubtful{0};  ///< numbers that may be too many
    std::int64_t doubtful_since{0};
    int prompt{0};   ///< samples in a row that came when they were due, since then
    int in_time{0};  ///< samples in a row that came no later than usual, since then
    SensorStreamHealth health;

    [[nodiscard]] const Sample* find(std::int64_t k) const;
    /// Newest first.
    template <class Do>
    void for_each_from(std::int64_t from, const Do& act);
    /// Gives the samples from `from` on numbers that are higher by so many.
    void renumber(std::int64_t from, std::int64_t by);
    void lessen_lateness(std::int64_t from, double by_s);
    void prove(std::int64_t from);
    [[nodiscard]] bool in_doubt() const { return late.samples > 0 || doubtful > 0; }
  };
  /// Where the reference sensor's samples lie while it has no clock model.
  struct Grid {
    double k{0}, t_s{0}, period_s{0};
  };
  enum class Need : std::uint8_t { ready, wait, lost, not_yet };
  enum class Why : std::uint8_t { lost, silent, not_yet, clock };
  struct Pick {
    Need need{Need::wait};
    double shift_s{0};  ///< left uninterpolated
    bool interpolated{false};
    Eigen::Vector3d y_nT;
    Flags flags;
    double doubt_s{0};  ///< by which its time may be wrong beside what the clock model says

    void take(const Sample& sample);
  };

  void begin(const Stamp& stamp);
  [[nodiscard]] double seconds(Instant t) const { return to_seconds(t - origin_); }
  [[nodiscard]] std::optional<std::int64_t> number(int slot, const FieldReading& reading, double sample_s);
  [[nodiscard]] bool comes_again(const Stream& s, const FieldReading& reading, double sample_s) const;
  [[nodiscard]] Step step(const Stream& s, const FieldReading& reading, double sample_s) const;
  [[nodiscard]] bool was_overcounted(Stream& s, double sample_s) const;
  void count_lost(Stream& s, std::int64_t frames) const;
  void restart(int slot);
  [[nodiscard]] std::int64_t first_number(int slot, double sample_s) const;
  [[nodiscard]] double late_from_s(const Stream& s) const;
  void watch_lateness(Stream& s, double arrival_s, double delay_s);
  void watch_doubt(Stream& s, double since_last_s, double delay_s) const;
  [[nodiscard]] bool in_doubt() const;
  [[nodiscard]] double grid_index(double t_s) const;
  [[nodiscard]] double grid_time(std::int64_t k) const;
  void emit_ready(std::vector<EpochOrGap>& out);
  void emit_silent_reference(std::vector<EpochOrGap>& out);
  [[nodiscard]] Pick pick(int slot, double t_s) const;
  [[nodiscard]] bool emit_next(std::vector<EpochOrGap>& out);
  void emit_epoch(double t_s, const PerSensor<Pick>& picks, std::vector<EpochOrGap>& out);
  void emit_gap(std::int64_t count, int slot, Why why, std::vector<EpochOrGap>& out);
  void flush_gap(std::vector<EpochOrGap>& out);
  [[nodiscard]] PerSensor<double> temperatures(Instant at) const;
  [[nodiscard]] Stamp stamp(double t_s) const;

  SamplerConfig config_;
  double period_s_;
  std::vector<Stream> streams_;
  PerSensor<double> T_degC_;
  PerSensor<Instant> T_at_{};
  bool begun_{false};
  Instant origin_{};
  std::int64_t origin_wall_ns_{0};  ///< wall clock at origin_, by the newest stamp
  double now_s_{0};                 ///< latest time known
  Grid grid_;
  std::int64_t next_k_{0};  ///< number of the next epoch in the reference sensor's count
  std::uint64_t next_seq_{0};
  double last_t_s_{0};           ///< of the last epoch
  std::optional<Gap> open_gap_;  ///< held back to be merged, at most a second
  double open_since_s_{0};
  int open_slot_{0};
  Why open_why_{Why::lost};
  std::uint64_t epochs_{0}, gaps_{0};
};

}  // namespace mgtd::daemon::acquire
