// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "proto/client_counts.h"
#include "proto/control_hold.h"
#include "proto/health.h"
#include "proto/run_status.h"
#include "proto/time.h"

/// Everything an operator asks a running daemon, in one value taken at one instant.
namespace mgtd {

struct DeviceStatus {
  std::string name;    ///< "s1" .. "s4", "table", "scalar"
  std::string driver;  ///< as in the configuration
  std::string port;
  LinkHealth health;
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

struct JournalStatus {
  std::string state;  ///< "off", "writing", or why it is not
  std::uint64_t bytes{0};
};

/// An effect of the calibration that is not removed now, and what it lacks ("s3_T_degC").
struct LeftOut {
  std::string effect, lacks;
};

/// How the active calibration is used.
struct CalibrationUse {
  bool forced{false};  ///< it failed its checks
  std::vector<LeftOut> left_out;
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
  double speed_up{1};
  std::optional<std::string> calibration;  ///< id of the active one
  CalibrationUse calibration_use;
  CriticismStatus criticism;
  std::vector<DeviceStatus> devices;
  SamplerStatus sampler;
  StreamStatus stream;
  ControlStatus control;
  JournalStatus journal;
  std::optional<std::uint64_t> disk_free_bytes;
  RunStatus run;
};

}  // namespace mgtd
