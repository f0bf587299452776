// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/config.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "calib/effects/library/library.h"
#include "daemon/config/array_places.h"
#include "daemon/config/input_columns.h"
#include "daemon/config/tcp_address.h"
#include "daemon/config/toml_settings.h"
#include "daemon/plan/mount_plan.h"
#include "daemon/store/durable_file.h"
#include "drivers/registry.h"
#include "proto/slot.h"

namespace mgtd::daemon::config {
namespace {

using drivers::Role;
using drivers::Settings;

/// Collects the mistakes of every section.
class Reader {
 public:
  explicit Reader(Config& config) : config_(config) {}

  void read(const toml::table& root);
  [[nodiscard]] std::vector<drivers::SettingError> take_errors();

 private:
  Settings section(const toml::table& root, std::string_view name);
  void close(Settings& settings);
  void read_rig(const toml::table& root);
  void read_site(const toml::table& root);
  void read_calibration(const toml::table& root);
  void read_disturbance(Settings& s, RunDefaults& r);
  void read_run(const toml::table& root);
  void read_console(const toml::table& root);
  void read_service(const toml::table& root);
  void read_array(const toml::table& root);
  void read_sensors(const toml::table& root);
  void read_auxiliary(const toml::table& root);
  void warn_without_field();
  DeviceConfig read_device(Settings settings, std::string name, Role role, int slot);
  void read_port(Settings& s, DeviceConfig& device);
  void read_mounts(Settings& s);
  void refuse_unknown_sections(const toml::table& root);
  void complain(drivers::Place place, std::string message) { errors_.push_back({place, std::move(message)}); }

  Config& config_;
  std::vector<drivers::SettingError> errors_;
  std::map<std::string, int> port_lines_, serial_lines_;
  InputColumns inputs_;
};

constexpr std::array<std::string_view, 14> kSections{"rig",       "array",   "sensor",      "table", "scalar",
                                                     "auxiliary", "site",    "calibration", "run",   "store",
                                                     "stream",    "control", "console",     "daemon"};

Settings Reader::section(const toml::table& root, std::string_view name) {
  const toml::node* const node = root.get(name);
  if (node == nullptr) return Settings(fmt::format("[{}]", name), 1);
  if (const toml::table* table = node->as_table()) return to_settings(*table, fmt::format("[{}]", name));
  complain(place_of(node->source()), fmt::format("'{0}' must be a section [{0}]", name));
  return Settings(fmt::format("[{}]", name), 1);
}

void Reader::close(Settings& settings) {
  settings.refuse_unknown();
  errors_.insert(errors_.end(), settings.errors().begin(), settings.errors().end());
}

void require(Settings& s, std::string_view key, bool ok, std::string_view rule) {
  if (!ok) s.object(key, fmt::format("must be {}", rule));
}

bool is_baseline(double baseline_m) { return baseline_m >= 0.05 && baseline_m <= 10; }

void Reader::read_rig(const toml::table& root) {
  Settings s = section(root, "rig");
  config_.rig_name = s.text("name", config_.rig_name);
  config_.baseline_m = s.number("baseline_m", config_.baseline_m);
  require(s, "baseline_m", is_baseline(config_.baseline_m), "between 0.05 and 10 m");
  config_.rate_hz = s.number("rate_hz", config_.rate_hz);
  require(s, "rate_hz", config_.rate_hz > 0 && config_.rate_hz <= 1000, "above 0 and at most 1000 Hz");
  close(s);
}

std::optional<double> optional_number(Settings& s, std::string_view key) {
  const double value = s.number(key, 0.0);
  return s.has(key) ? std::optional(value) : std::nullopt;
}

void Reader::read_site(const toml::table& root) {
  Settings s = section(root, "site");
  config_.field_nT = optional_number(s, "field_nT");
  require(s, "field_nT", !config_.field_nT || (*config_.field_nT > 1000 && *config_.field_nT < 200'000),
          "a total field in nT, 1000 to 200000");
  config_.field_sd_nT = s.number("field_sd_nT", config_.field_sd_nT);
  require(s, "field_sd_nT", config_.field_sd_nT >= 0, "0 nT or more");
  config_.inclination_deg = optional_number(s, "inclination_deg");
  require(s, "inclination_deg", !config_.inclination_deg || std::abs(*config_.inclination_deg) <= 90,
          "-90 to 90 deg");
  config_.declination_deg = optional_number(s, "declination_deg");
  config_.table_sd_deg = s.number("table_sd_deg", config_.table_sd_deg);
  require(s, "table_sd_deg", config_.table_sd_deg > 0 && config_.table_sd_deg < 10,
          "above 0 and below 10 deg");
  close(s);
}

void Reader::read_calibration(const toml::table& root) {
  Settings s = section(root, "calibration");
  config_.effects = s.texts("effects");
  for (const std::string& effect : config_.effects) {
    if (const auto known = calib::effects::library::make_effect(effect); !known)
      s.object("effects", known.error().message);
  }
  close(s);
}

void Reader::read_disturbance(Settings& s, RunDefaults& r) {
  r.disturbance_nT = s.number("disturbance_nT", r.disturbance_nT);
  require(s, "disturbance_nT", r.disturbance_nT > 0, "above 0 nT");
  r.false_alarm = s.number("false_alarm", r.false_alarm);
  require(s, "false_alarm", r.false_alarm >= 1e-12 && r.false_alarm <= 0.1, "1e-12 to 0.1 of the dwells");
  r.field_step_nT = s.number("field_step_nT", r.field_step_nT);
  require(s, "field_step_nT", r.field_step_nT >= 0, "0 (not looked at) or more");
  r.calm_s = s.number("calm_s", r.calm_s);
  require(s, "calm_s", r.calm_s >= 1, "1 s or more");
  r.calm_max_s = s.number("calm_max_s", r.calm_max_s);
  require(s, "calm_max_s", r.calm_s < 1 || r.calm_max_s > r.calm_s, "longer than calm_s");
}

void Reader::read_run(const toml::table& root) {
  Settings s = section(root, "run");
  RunDefaults& r = config_.run;
  r.step_deg = s.number("step_deg", r.step_deg);
  require(s, "step_deg", r.step_deg == 10 || r.step_deg == 20, "10 or 20 deg");
  r.random = s.small_integer("random", r.random);
  require(s, "random", r.random >= 0 && r.random <= 100'000, "0 to 100000 poses");
  r.revisits = s.small_integer("revisits", r.revisits);
  require(s, "revisits", r.revisits >= 0 && 2 * r.revisits <= std::max(r.random, 0),
          "at most half of 'random'");
  const std::vector<double> dwell = s.numbers("dwell_s", 2, {r.dwell_short_s, r.dwell_long_s});
  r.dwell_short_s = dwell[0];
  r.dwell_long_s = dwell[1];
  require(s, "dwell_s", dwell[0] > 0 && dwell[1] >= dwell[0], "two lengths in s, the short one first");
  r.settle_min_s = s.number("settle_min_s", r.settle_min_s);
  r.settle_max_s = s.number("settle_max_s", r.settle_max_s);
  require(s, "settle_max_s", r.settle_min_s >= 0 && r.settle_max_s > r.settle_min_s,
          "longer than settle_min_s");
  r.preflight_s = s.number("preflight_s", r.preflight_s);
  require(s, "preflight_s", r.preflight_s >= 1, "1 s or more");
  r.retries = s.small_integer("retries", r.retries);
  require(s, "retries", r.retries >= 0, "0 or more");
  read_disturbance(s, r);
  r.answer_max_s = s.number("answer_max_s", r.answer_max_s);
  require(s, "answer_max_s", r.answer_max_s >= 10, "10 s or more");
  const std::int64_t seed = s.integer("seed", static_cast<std::int64_t>(r.seed));
  require(s, "seed", seed >= 0, "0 or more");
  r.seed = static_cast<std::uint64_t>(seed);
  close(s);
}

void Reader::read_console(const toml::table& root) {
  Settings s = section(root, "console");
  config_.console_listen = s.text("listen", config_.console_listen);
  if (const auto address = parse_tcp_address(config_.console_listen);
      !config_.console_listen.empty() && !address)
    s.object("listen", address.error().text());
  config_.console_hosts = s.texts("hosts");
  for (const std::string& host : config_.console_hosts)
    require(s, "hosts", !host.empty() && host.find_first_of("/ \t@") == std::string::npos,
            "names or addresses of this computer without http:// and port, like \"rig7.local\"");
  const std::string from = s.text("control_from", "loopback");
  require(s, "control_from", from == "loopback" || from == "network", "\"loopback\" or \"network\"");
  config_.console_control_from_network = from == "network";
  close(s);
}

void Reader::read_service(const toml::table& root) {
  Settings store = section(root, "store");
  config_.store_dir = store.text("dir", config_.store_dir);
  config_.journal = store.boolean("journal", config_.journal);
  config_.journal_mb = store.integer("journal_mb", config_.journal_mb);
  require(store, "journal_mb", config_.journal_mb == 0 || config_.journal_mb >= 16,
          "16 MB or more, or 0 for no limit");
  config_.journal_days = store.number("journal_days", config_.journal_days);
  require(store, "journal_days", config_.journal_days >= 0 && config_.journal_days <= 36'500,
          "0 (no limit) to 36500 days");
  config_.ring_mb = store.integer("ring_mb", config_.ring_mb);
  require(store, "ring_mb", config_.ring_mb == 0 || (config_.ring_mb >= 1 && config_.ring_mb <= 1'000'000),
          "1 to 1000000 MB, or 0 for none");
  config_.reserve_mb = store.integer("reserve_mb", config_.reserve_mb);
  require(store, "reserve_mb", config_.reserve_mb >= 0, "0 MB or more");
  close(store);
  Settings stream = section(root, "stream");
  config_.stream_tcp = stream.text("tcp", config_.stream_tcp);
  if (const auto address = parse_tcp_address(config_.stream_tcp); !config_.stream_tcp.empty() && !address)
    stream.object("tcp", address.error().text());
  config_.stream_unix = stream.text("unix", config_.stream_unix);
  close(stream);
  Settings control = section(root, "control");
  config_.control_unix = control.text("unix", config_.control_unix);
  const std::string mode = control.text("mode", "0660");
  const bool octal =
      mode.size() <= 4 && !mode.empty() && mode.find_first_not_of("01234567") == std::string::npos;
  require(control, "mode", octal, "file permissions in octal, like \"0660\"");
  if (octal) config_.control_mode = static_cast<int>(std::strtol(mode.c_str(), nullptr, 8));
  close(control);
  read_console(root);
  Settings daemon = section(root, "daemon");
  config_.log_level = daemon.text("log_level", config_.log_level);
  static constexpr std::array<std::string_view, 4> kLogLevels{"debug", "info", "warn", "error"};
  require(daemon, "log_level",
          std::find(kLogLevels.begin(), kLogLevels.end(), config_.log_level) != kLogLevels.end(),
          "debug, info, warn or error");
  config_.speed_up = daemon.number("speed_up", config_.speed_up);
  require(daemon, "speed_up", config_.speed_up >= 1 && config_.speed_up <= 1000, "1 (real time) to 1000");
  close(daemon);
}

std::string driver_names(Role role) {
  std::string names;
  for (const auto& entry : drivers::drivers()) {
    if (entry.role == role) names += (names.empty() ? "" : ", ") + std::string(entry.name);
  }
  return names;
}

void Reader::read_port(Settings& s, DeviceConfig& device) {
  device.port = s.required_text("port");
  if (device.port.empty()) return;
  const auto [where, fresh] = port_lines_.emplace(device.port, s.place_of("port").line);
  if (!fresh) s.object("port", fmt::format("'{}' is already used in line {}", device.port, where->second));
}

void Reader::read_mounts(Settings& s) {
  const bool by_hand = s.boolean("mount_by_hand", false);
  const std::vector<std::string> ways = s.texts("mounts");
  for (const std::string& way : ways) {
    const auto mounting = plan::parse_mounting(way);
    if (mounting)
      config_.mounts.push_back(*mounting);
    else
      s.object("mounts", mounting.error().text());
  }
  if (by_hand && ways.empty()) config_.mounts = plan::usual_mounts();
  if (!by_hand) config_.mounts.clear();
}

DeviceConfig Reader::read_device(Settings s, std::string name, Role role, int slot) {
  DeviceConfig device;
  device.name = std::move(name);
  device.driver = s.required_text("driver");
  device.latency_s = s.number("latency_s", 0.0);
  const drivers::DriverEntry* const entry = drivers::find_driver(device.driver);
  if (entry == nullptr || entry->role != role) {
    if (s.has("driver")) {
      s.object("driver",
               fmt::format("no such driver here: '{}'; there are: {}", device.driver, driver_names(role)));
    }
    errors_.insert(errors_.end(), s.errors().begin(), s.errors().end());
    return device;
  }
  if (entry->has_port) read_port(s, device);
  if (role == Role::table) read_mounts(s);
  if (role == Role::sensor) {
    device.delivery_s = s.number("delivery_s", device.delivery_s);
    if (!(device.delivery_s >= 0 && device.delivery_s <= 1))
      s.object("delivery_s", "the step of delivery must be 0 to 1 s; USB converters have 0.001 to 0.016 s");
  }
  device.device = entry->make(slot, s);
  if (const std::string serial = s.has("serial") ? s.text("serial", "") : ""; !serial.empty()) {
    const auto [where, fresh] = serial_lines_.emplace(serial, s.place_of("serial").line);
    if (!fresh) s.object("serial", fmt::format("'{}' is already used in line {}", serial, where->second));
  }
  device.baud = s.small_integer("baud", 0);
  inputs_.add(s, device, config_);
  close(s);
  return device;
}

void Reader::read_array(const toml::table& root) {
  config_.array = config::read_array(root, errors_);
  if (!config_.array) return;
  if (const auto baseline_m = config_.array->cross_baseline_m(); baseline_m && is_baseline(*baseline_m))
    config_.baseline_m = *baseline_m;
}

void Reader::read_sensors(const toml::table& root) {
  const toml::array* const list = root.get("sensor") == nullptr ? nullptr : root.get("sensor")->as_array();
  const std::size_t count = list == nullptr ? 0 : list->size();
  const bool array_is_wrong = root.get("array") != nullptr && !config_.array;
  const std::size_t needed =
      array_is_wrong ? std::clamp<std::size_t>(count, 1, kMostSensors) : config_.geometry().sensors();
  if (count != needed) {
    complain(
        list == nullptr ? drivers::Place() : place_of(list->source()),
        config_.array
            ? fmt::format("[array] has {} places, so {} [[sensor]] sections are needed, s1 to "
                          "s{} in this order; found {}",
                          needed, needed, needed, count)
            : fmt::format("four [[sensor]] sections are needed, s1 to s4 in this order; found {}", count));
    if (count == 0) return;
  }
  config_.sensors.resize(needed);
  for (std::size_t i = 0; i < std::min(count, needed); ++i) {
    const toml::table* const table = list->get(i)->as_table();
    const std::string name = fmt::format("s{}", i + 1);
    if (table == nullptr) {
      complain(place_of(list->get(i)->source()), "a [[sensor]] must be a section");
      continue;
    }
    Settings s = to_settings(*table, "[[sensor]] " + name);
    config_.sensors.at(i) = read_device(std::move(s), name, Role::sensor, static_cast<int>(i));
  }
}

void Reader::read_auxiliary(const toml::table& root) {
  const toml::node* const node = root.get("auxiliary");
  if (node == nullptr) return;
  const toml::array* const list = node->as_array();
  if (list == nullptr || !list->is_homogeneous<toml::table>()) {
    complain(place_of(node->source()), "each module is a section of its own: [[auxiliary]]");
    return;
  }
  for (const toml::node& module : *list) {
    if (config_.auxiliary.size() == Slot::kMostAuxiliary)
      return complain(place_of(module.source()),
                      fmt::format("there can be {} auxiliary modules", Slot::kMostAuxiliary));
    const std::string name = fmt::format("aux{}", config_.auxiliary.size() + 1);
    Settings s = to_settings(*module.as_table(), "[[auxiliary]] " + name);
    config_.auxiliary.push_back(read_device(std::move(s), name, Role::auxiliary, 0));
  }
}

void Reader::refuse_unknown_sections(const toml::table& root) {
  for (const auto& [key, node] : root) {
    if (std::find(kSections.begin(), kSections.end(), key.str()) == kSections.end()) {
      complain(place_of(key.source()),
               fmt::format("unknown section '{}'; there are: {}", key.str(), fmt::join(kSections, ", ")));
    }
  }
}

void Reader::read(const toml::table& root) {
  refuse_unknown_sections(root);
  read_rig(root);
  read_array(root);
  read_sensors(root);
  if (const toml::node* table = root.get("table"); table != nullptr && table->is_table()) {
    config_.table = read_device(to_settings(*table->as_table(), "[table]"), "table", Role::table, 0);
  } else {
    complain(1, "the [table] section is missing: which turntable, on which port?");
  }
  if (const toml::node* scalar = root.get("scalar"); scalar != nullptr && scalar->is_table()) {
    config_.scalar = read_device(to_settings(*scalar->as_table(), "[scalar]"), "scalar", Role::scalar, 0);
  }
  read_auxiliary(root);
  read_site(root);
  read_calibration(root);
  read_run(root);
  read_service(root);
  warn_without_field();
}

/// The size of the field fixes the scale of all sensors.
void Reader::warn_without_field() {
  if (config_.scalar || config_.field_nT) return;
  config_.warnings.push_back(fmt::format(
      "{}: warning: neither [scalar] nor field_nT in [site]: a run cannot be calibrated, the size "
      "of the field is not known",
      config_.file));
}

std::vector<drivers::SettingError> Reader::take_errors() {
  std::stable_sort(errors_.begin(), errors_.end(),
                   [](const auto& a, const auto& b) { return a.line < b.line; });
  return std::move(errors_);
}

}  // namespace

tl::expected<Config, ConfigErrors> parse_config(std::string text, std::string_view file) {
  Config config;
  config.file = file;
  const auto root = parse_toml(text, file);
  if (!root) return tl::unexpected(ConfigErrors{{root.error()}});
  config.text = std::move(text);
  Reader reader(config);
  reader.read(*root);
  ConfigErrors errors;
  for (const drivers::SettingError& error : reader.take_errors())
    errors.lines.push_back(fmt::format("{}:{}:{}: {}", file, error.line, error.column, error.message));
  if (!errors.lines.empty()) return tl::unexpected(std::move(errors));
  return config;
}

tl::expected<Config, ConfigErrors> load_config(const std::string& path) {
  auto text = store::read_file(path);
  if (!text) {
    return tl::unexpected(
        ConfigErrors{{text.error().message +
                      "; name a configuration with --config (a commented one is systemd/mgtd.toml)"}});
  }
  return parse_config(*std::move(text), path);
}

}  // namespace mgtd::daemon::config
