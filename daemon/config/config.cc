// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/config.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "daemon/config/array_places.h"
#include "daemon/config/input_columns.h"
#include "daemon/config/toml_settings.h"
#include "daemon/config/value_sections.h"
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
  for (const ValueSection& values : value_sections()) {
    Settings settings = section(root, values.name);
    values.read(settings, config_);
    close(settings);
  }
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
  warn_without_field();
}

/// The size of the field fixes the scale of all sensors.
void Reader::warn_without_field() {
  if (config_.scalar || config_.site.field_nT) return;
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
