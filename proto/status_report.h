// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "proto/array_description.h"
#include "proto/client_counts.h"
#include "proto/control_hold.h"
#include "proto/health.h"
#include "proto/magnet_status.h"
#include "proto/run_status.h"
#include "proto/time.h"

/// A StatusReport answers everything an operator asks a running daemon, in one value taken at one instant.
namespace mgtd {

/// Of a free-running digitiser: how its samples are placed in time.
struct ClockStatus {
  double rate_error{0};     ///< samples a second against what was asked for, relative; negative: slow
  double rate_error_pm{0};  ///< the true one lies no further than this from it
  double bound_s{0};        ///< so do the true sample times, from the estimated ones
  double delivery_s{0};     ///< the longest step of delivery, as assumed
  bool settled{false};
  std::string trouble;  ///< what is wrong with its rate and what to do; empty: nothing
};

struct DeviceStatus {
  std::string name;    ///< "s1", "s2", ..., "table", "scalar"
  std::string driver;  ///< as in the configuration
  std::string port;
  LinkHealth health;
  std::optional<ClockStatus> clock{};  ///< of a sensor that has sent samples
  std::optional<double> rate_hz{};     ///< good frames a second of late; empty: not known yet
};

/// An auxiliary input or a sensor's thermometer.
struct InputStatus {
  std::string name;              ///< its column
  std::string device;            ///< that measures it
  std::string input;             ///< as that device calls it
  std::string unit;              ///< empty: not known
  std::optional<double> value;   ///< empty: not known now
  std::optional<Instant> heard;  ///< when it was last measured
};

struct SamplerStatus {
  std::uint64_t epochs{0};
  std::uint64_t gaps{0};  ///< epochs that were not measured
  std::optional<double> rate_hz;
  std::optional<double> skew_bound_s;  ///< of the newest epoch
};

struct StreamStatus : ClientCounts {
  std::uint64_t gaps{0};  ///< GAP records sent to clients that were too slow
};

struct ControlStatus : ClientCounts {
  std::optional<ControlHolder> holder;
};

/// Something that is recorded all the time: the raw journal, the stream's samples.
struct RecordingStatus {
  std::string state{"off"};     ///< "off", "writing" or "stopped"
  std::string why;              ///< while it is stopped, and what to do
  std::uint64_t bytes{0};       ///< written since the start
  std::uint64_t bytes_lost{0};  ///< not written because the disk refused
  std::uint64_t stops{0};       ///< how often it did
};

/// An effect of the calibration that is not removed now, and what it lacks ("s3_T_degC").
struct LeftOut {
  std::string effect, lacks;
};

/// How the active calibration is used, and how far the conditions are from those that it was made in.
struct CalibrationUse {
  bool forced{false};  ///< it failed its checks
  std::vector<LeftOut> left_out;
  std::optional<double> age_s{};  ///< since its run began; empty: not known
  /// Temperatures of the heads, sensor by sensor: mean of its run, and the last; no elements without a
  /// calibration.
  std::vector<std::optional<double>> made_at_degC{}, now_degC{};
};

/// What the stream itself says of the calibration.
struct CriticismStatus {
  std::string state{"none"};  ///< "none" (nothing to judge with), "learning", "ok", "suspect", "near source"
  std::string measured, limit, remedy;
};

struct StatusReport {
  Stamp at;
  double uptime_s{0};
  std::string software;
  std::string rig;
  ArrayDescription array;
  double speed_up{1};
  std::optional<std::string> calibration;  ///< id of the active one
  CalibrationUse calibration_use;
  CriticismStatus criticism;
  std::vector<DeviceStatus> devices;
  std::vector<InputStatus> inputs;
  SamplerStatus sampler;
  StreamStatus stream;
  ControlStatus control;
  RecordingStatus journal;
  RecordingStatus ring;                     ///< the stream's samples on disk
  std::optional<std::string> console;       ///< its address
  std::optional<std::uint64_t> oldest_seq;  ///< from where on a client gets them
  std::optional<std::uint64_t> disk_free_bytes;
  RunStatus run;
  std::optional<MagnetStatus> magnet;  ///< while a magnet test is going on
};

}  // namespace mgtd
