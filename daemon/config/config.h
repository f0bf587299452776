// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calib/sensor/geometry.h"
#include "drivers/device.h"
#include "drivers/settings.h"
#include "proto/error.h"
#include "proto/reading.h"

/// Config holds what mgtd.toml says. The file is read once at start; every mistake in it is reported at once,
/// with file and line, and a file with a mistake starts nothing. systemd/mgtd.toml lists every key with its
/// unit and default.
namespace mgtd::daemon::config {

/// A serial port and the device behind it. The device has read and checked its own settings.
struct DeviceConfig {
  std::string name;  ///< "s1", "s2", ..., "table", "scalar", "aux1", ...
  std::string driver;
  std::string port;
  int baud{0};
  double latency_s{0};       ///< fixed delay between the field and the last byte, beyond the wire time
  double delivery_s{0.016};  ///< longest step in which its bytes are delivered; of a sensor
  std::shared_ptr<drivers::Device> device;
};

struct RunDefaults {
  double step_deg{10};
  int random{121};
  int revisits{24};
  double dwell_short_s{4};
  double dwell_long_s{8};
  double settle_min_s{0.5};
  double settle_max_s{30};
  double preflight_s{5};
  int retries{3};
  double disturbance_nT{0.5};  ///< change of the field while the table stands, rms
  double false_alarm{1e-4};    ///< of it, in a dwell
  double field_step_nT{5};     ///< of the scalar reference from pose to pose; 0: not looked at
  double calm_s{5}, calm_max_s{600};
  double answer_max_s{900};
  std::uint64_t seed{1};
};

/// What is known of the place beside the readings.
struct SiteSection {
  std::optional<double> field_nT;  ///< when no scalar reference is there
  double field_sd_nT{0};
  std::optional<double> inclination_deg, declination_deg;
  double table_sd_deg{0.1};
};

struct StoreSection {
  std::string dir{"/var/lib/mgtd"};
  bool journal{true};
  std::int64_t journal_mb{8192};  ///< of all raw journals together; 0: no limit
  double journal_days{0};         ///< older ones are removed; 0: no limit
  std::int64_t ring_mb{256};      ///< of the stream's samples; 0: they are not kept
  std::int64_t reserve_mb{256};   ///< left free on the disk: below it journal and samples are not recorded
};

struct StreamSection {
  std::string tcp{"127.0.0.1:7450"};
  std::string unix_path{"/run/mgtd/stream.sock"};
};

struct ControlSection {
  std::string unix_path{"/run/mgtd/control.sock"};
  int mode{0660};
};

struct ConsoleSection {
  std::string listen{"127.0.0.1:7451"};  ///< empty: there is no web console
  std::vector<std::string> hosts;        ///< further names of this computer in a browser
  bool control_from_network{false};      ///< else control is for browsers on this computer
};

struct Config {
  std::string file;
  std::string text;  ///< as read: kept in every run file
  std::string rig_name{"rig"};
  double baseline_m{0.4};                        ///< of the cross
  std::optional<calib::sensor::Geometry> array;  ///< [array]; empty: the cross
  double rate_hz{50};                            ///< of the epochs; every sensor must deliver it
  PerSensor<DeviceConfig> sensors;               ///< as many as the array has
  DeviceConfig table;
  std::optional<DeviceConfig> scalar;
  std::vector<DeviceConfig> auxiliary;
  std::vector<TableAngles> mounts;  ///< ways in which the array is mounted on the table by hand; may be empty

  [[nodiscard]] calib::sensor::Geometry geometry() const {
    return array.value_or(calib::sensor::Geometry(baseline_m));
  }
  /// The table is turned by hand.
  [[nodiscard]] bool by_hand() const { return table.driver == "hand"; }

  SiteSection site;
  /// Effects that the model of every run begins with, by their names in the library.
  std::vector<std::string> effects;

  RunDefaults run;
  StoreSection store;
  StreamSection stream;
  ControlSection control;
  ConsoleSection console;
  std::string log_level{"info"};
  double speed_up{1};

  /// What is no mistake and will be missed all the same, ready to print.
  std::vector<std::string> warnings;
};

/// All mistakes of a configuration, in the order of their lines, ready to print: "mgtd.toml:12:1: ...".
struct ConfigErrors {
  std::vector<std::string> lines;
};

[[nodiscard]] tl::expected<Config, ConfigErrors> parse_config(std::string text, std::string_view file);
[[nodiscard]] tl::expected<Config, ConfigErrors> load_config(const std::string& path);

}  // namespace mgtd::daemon::config
