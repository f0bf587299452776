// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/scenario.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/rig/array_section.h"
#include "tests/rig/disturbance_section.h"
#include "tests/rig/effect_list.h"
#include "tests/rig/effects/site_record.h"
#include "tests/rig/effects/temperature_law.h"
#include "tests/rig/fault.h"
#include "tests/rig/known_field_section.h"
#include "tests/rig/noise_section.h"
#include "tests/rig/rotations.h"
#include "tests/rig/section.h"

namespace mgtd::rig {
namespace {

void read_wave(Section& section, Wave& wave) {
  std::string text = "toggle";
  section.read("wave", text);
  if (text != "toggle" && text != "sine" && text != "ramp")
    section.complain("wave", "wave must be toggle, sine or ramp");
  wave = text == "sine" ? Wave::sine : text == "ramp" ? Wave::ramp : Wave::toggle;
}

class Reader {
 public:
  explicit Reader(const toml::table& root) : root_(root) {}
  [[nodiscard]] Scenario read();
  /// In the order of the lines.
  [[nodiscard]] std::vector<Mistake> mistakes() &&;

 private:
  Section section(std::string_view name) { return {root_.get(name), std::string(name), mistakes_, sensors_}; }
  void refuse_unknown_sections();
  void read_array(Scenario& s);
  void read_rig(Scenario& s);
  void read_sensor(std::size_t i, SensorTruth& truth);
  void read_site(Scenario& s);
  void read_record(Section& site, Scenario& s);
  void read_temperature(Scenario& s);
  void read_sensors(Scenario& s);
  static void read_order(Section& sensors, const char* key, std::vector<int>& order);
  void read_table(Scenario& s);
  void read_scalar(Scenario& s);
  void read_covariates(Scenario& s);
  void read_effects(Scenario& s);
  void read_faults(Scenario& s);
  template <class Body>
  void for_each(std::string_view name, Body body);

  const toml::table& root_;
  std::vector<Mistake> mistakes_;
  std::size_t sensors_{kCross};
};

void Reader::refuse_unknown_sections() {
  std::set<std::string> sections{"rig",       "site",   "temperature", "sensors", "array",     "visit",
                                 "table",     "scalar", "reference",   "cage",    "recording", "effect",
                                 "covariate", "fault",  "vehicle",     "magnet",  "gross"};
  for (std::size_t i = 1; i <= sensors_; ++i) sections.insert(fmt::format("s{}", i));
  for (const auto& [key, node] : root_) {
    if (!sections.contains(std::string(key.str()))) {
      mistakes_.push_back({node.source().begin.line, fmt::format("unknown section '{}'; there are: {}",
                                                                 key.str(), fmt::join(sections, ", "))});
    }
  }
}

void Reader::read_array(Scenario& s) {
  Section array = section("array");
  s.positions_m = read_positions(array);
  if (!s.is_cross()) sensors_ = s.positions_m.size();
  array.refuse_rest();
}

void Reader::read_rig(Scenario& s) {
  Section rig = section("rig");
  rig.read("name", s.name);
  rig.read("parameters", s.rig);
  rig.read("seed", s.seed);
  rig.read("baseline_m", s.baseline_m, {0.01, 100});
  if (!s.is_cross() && rig.has("baseline_m"))
    rig.complain("baseline_m",
                 "baseline_m is of the cross; here [array] positions_m says where the sensors are");
  s.truth = RigTruth(sensors_);
  if (const auto truth = rig_named(s.rig, s.seed, sensors_)) {
    s.truth = *truth;
  } else if (of_the_cross(s.rig)) {
    rig.complain(
        "parameters",
        fmt::format("{} of four sensors, the array has {}; say {}ideal or random",
                    rig.has("parameters")
                        ? fmt::format("parameters = '{}' are", s.rig)
                        : fmt::format("no parameters are given, and those of the default, '{}', are", s.rig),
                    sensors_, rig.has("parameters") ? "" : "parameters = "));
  } else {
    rig.complain("parameters",
                 fmt::format("parameters = '{}' must be table3, table6, ideal or random", s.rig));
  }
  rig.refuse_rest();
  for (std::size_t i = 0; i < s.truth.size(); ++i) read_sensor(i, s.truth.at(i));
}

/// What differs from the named rig.
void Reader::read_sensor(std::size_t i, SensorTruth& truth) {
  Section sensor = section(fmt::format("s{}", i + 1));
  for (auto& [key, value] : named_parameters(truth)) sensor.read(key, *value);
  std::string mounting;
  sensor.read("mounting", mounting);
  if (!mounting.empty()) {
    if (const auto found = parse_mounting(mounting)) {
      truth.mounting = *found;
    } else {
      sensor.complain("mounting",
                      fmt::format("mounting = '{}' must say where the sensor's x, y and z point on the "
                                  "platform, e.g. \"y -x z\"",
                                  mounting));
    }
  }
  sensor.refuse_rest();
}

void Reader::read_site(Scenario& s) {
  Section site = section("site");
  site.read("f_nT", s.f_nT, {1000, 1e6});
  site.read("inclination_deg", s.inclination_deg, {-90, 90});
  site.read("declination_deg", s.declination_deg, {-360, 360});
  site.read("drift_nT_per_h", s.field_drift_nT_per_h);
  site.read("diurnal_nT", s.diurnal_nT);
  site.read("diurnal_period_h", s.diurnal_period_h, {0.01, 1000});
  read_record(site, s);
  site.refuse_rest();
}

void Reader::read_record(Section& site, Scenario& s) {
  std::string record;
  double start_h = 18;
  site.read("record", record);
  site.read("record_start_h", start_h, {0, 24});
  if (record.empty()) return;
  if (const auto found = SiteRecord::named(record, start_h)) {
    s.effects.push_back(std::make_shared<SiteRecord>(*found));
  } else {
    site.complain("record", fmt::format("record = '{}'; there are: {}", record, SiteRecord::names()));
  }
}

void Reader::read_temperature(Scenario& s) {
  TemperatureScript& script = s.temperature;
  Section temperature = section("temperature");
  temperature.read("start_degC", script.start_degC, {-60, 80});
  temperature.read("ramp_degC_per_h", script.ramp_degC_per_h, {-1000, 1000});
  temperature.read("head_degC", script.head_degC);
  temperature.read("pulse_degC", script.pulse_degC, {-60, 60});
  temperature.read("pulse_at_s", script.pulse_at_s);
  temperature.read("pulse_tau_s", script.pulse_tau_s, {1, 1e6});
  temperature.read("pulse_head", script.pulse_head);
  std::string law;
  temperature.read("law", law);
  if (law == "calib1520") {
    s.effects.push_back(std::make_shared<TemperatureLaw>());
  } else if (!law.empty()) {
    temperature.complain("law", fmt::format("law = '{}' must be calib1520", law));
  }
  if (script.pulse_head > sensors_)
    temperature.complain("pulse_head", fmt::format("pulse_head must be 1 .. {}, or 0 for all", sensors_));
  temperature.refuse_rest();
}

void Reader::read_sensors(Scenario& s) {
  Section sensors = section("sensors");
  read_sample_noise(sensors, s.noise);
  read_order(sensors, "wiring", s.wiring);
  read_order(sensors, "plugs", s.plugs);
  sensors.read("tells_serial", s.tells_serial);
  sensors.read("copied", s.copied);
  if (s.copied > sensors_)
    sensors.complain("copied", fmt::format("copied must be 1 .. {}, or 0 for none", sensors_));
  sensors.read("apart", s.apart);
  sensors.read("rate_hz", s.rate_hz, {1, 1000});
  sensors.read("range_V", s.range_V);
  if (s.range_V != 10 && s.range_V != 5 && s.range_V != 2.5)
    sensors.complain("range_V", "range_V must be 10, 5 or 2.5");
  sensors.read("uT_full_scale", s.uT_full_scale, {1, 10'000});
  sensors.read("palmacq", s.palmacq);
  sensors.read("common_trigger", s.common_trigger);
  sensors.read("autostart", s.autostart);
  sensors.read("oscillator_ppm", s.oscillator_ppm, {0, 10'000});
  sensors.read("rate_error_percent", s.rate_error_percent);
  for (const double percent : s.rate_error_percent) {
    if (!(std::abs(percent) <= 20))
      sensors.complain("rate_error_percent", "rate_error_percent must be within 20 %");
  }
  sensors.read("delivery_s", s.delivery_s);
  for (const double step_s : s.delivery_s) {
    if (!(step_s >= 0 && step_s <= 1)) sensors.complain("delivery_s", "delivery_s must be 0 to 1 s");
  }
  sensors.read("delivery_ppm", s.delivery_ppm);
  sensors.refuse_rest();
}

void Reader::read_order(Section& sensors, const char* key, std::vector<int>& order) {
  std::vector<double> all, read;
  for (std::size_t i = 1; i <= sensors.sensors(); ++i) all.push_back(static_cast<double>(i));
  read = all;
  sensors.read(key, read);
  if (std::set<double>(read.begin(), read.end()) != std::set<double>(all.begin(), all.end()))
    sensors.complain(key, fmt::format("{} must be 1 to {} in some order", key, all.size()));
  for (const double w : read) order.push_back(static_cast<int>(w));
}

void Reader::read_table(Scenario& s) {
  Section table = section("table");
  table.read("accuracy_deg", s.table_accuracy_deg, {0, 10});
  table.read("velocity_deg_per_s", s.table_velocity_deg_per_s, {0.01, 720});
  table.read("acceleration_deg_per_s2", s.table_acceleration_deg_per_s2, {0.01, 10'000});
  table.read("tilt_limit_deg", s.tilt_limit_deg, {0, 360});
  table.read("hands", s.hands);
  if (s.hands != "none" && s.hands != "mount" && s.hands != "table")
    table.complain("hands", fmt::format("'{}' is not none, mount or table", s.hands));
  table.refuse_rest();
}

void Reader::read_scalar(Scenario& s) {
  Section scalar = section("scalar");
  scalar.read("present", s.scalar);
  scalar.read("noise_nT", s.scalar_noise_nT, {0, 1e5});
  scalar.read("period_s", s.scalar_period_s, {0.05, 60});
  scalar.read("bad_every", s.scalar_bad_every);
  scalar.refuse_rest();
}

/// Every table of an array of tables.
template <class Body>
void Reader::for_each(std::string_view name, Body body) {
  const toml::node* const node = root_.get(name);
  if (node == nullptr) return;
  if (!node->is_array()) {
    Section(node, std::string(name), mistakes_)
        .complain("", fmt::format("write [[{}]], with two brackets", name));
    return;
  }
  for (const toml::node& item : *node->as_array()) {
    Section section(&item, std::string(name), mistakes_, sensors_);
    body(section);
    section.refuse_rest();
  }
}

/// input = "s2.q", with unit, per_V and at_0V.
void read_input(Section& section, Covariate& c) {
  std::string of;
  CovariateInput input;
  section.read("input", of);
  section.read("unit", input.unit);
  section.read("per_V", input.per_V);
  section.read("at_0V", input.at_0V);
  if (of.empty()) return;
  const auto dot = of.find('.');
  const std::string letter = dot == std::string::npos ? "" : of.substr(dot + 1);
  const auto sensor = Where::parse(of.substr(0, dot), section.sensors());
  const bool known = sensor && of[0] == 's' && (letter == "q" || letter == "r");
  if (!known) {
    section.complain("input",
                     fmt::format("input = '{0}': s1.q, s1.r .. s{1}.q, s{1}.r; the thermometer is on p", of,
                                 section.sensors()));
  }
  if (input.per_V == 0) section.complain("per_V", "per_V must not be 0");
  if (!known || input.per_V == 0) return;
  while (!sensor->covers_sensor(input.slot)) ++input.slot;
  input.letter = letter[0];
  c.input = std::move(input);
}

void Reader::read_covariates(Scenario& s) {
  for_each("covariate", [&](Section& section) {
    Covariate c;
    section.read("name", c.name);
    section.read("mean", c.mean);
    section.read("amplitude", c.amplitude);
    read_wave(section, c.wave);
    section.read("every_s", c.every_s, {0.1, 1e6});
    section.read("recorded", c.recorded);
    section.read("pattern", c.pattern);
    read_input(section, c);
    for (const Covariate& other : s.covariates) {
      const bool same = c.input && other.input && other.input->slot == c.input->slot &&
                        other.input->letter == c.input->letter;
      if (same) section.complain("input", fmt::format("'{}' is on that input already", other.name));
    }
    s.covariates.push_back(std::move(c));
  });
}

void Reader::read_effects(Scenario& s) {
  for_each("effect", [&](Section& section) {
    auto effect = read_effect(section);
    if (effect == nullptr) return;
    const std::string of = effect->covariate();
    const auto known = [&](const Covariate& c) { return c.name == of; };
    if (!of.empty() && std::none_of(s.covariates.begin(), s.covariates.end(), known))
      section.complain("of", fmt::format("of = '{}': there is no [[covariate]] of that name", of));
    s.effects.push_back(std::move(effect));
  });
}

void Reader::read_faults(Scenario& s) {
  for_each("fault", [&](Section& section) {
    TimedFault timed;
    section.read("at_s", timed.at_s, {0, 1e9});
    section.read("do", timed.text);
    if (const auto parsed = parse_fault(timed.text, sensors_); !parsed)
      section.complain("do", parsed.error());
    s.faults.push_back(std::move(timed));
  });
  std::stable_sort(s.faults.begin(), s.faults.end(),
                   [](const auto& a, const auto& b) { return a.at_s < b.at_s; });
}

Scenario Reader::read() {
  Scenario scenario;
  read_array(scenario);
  refuse_unknown_sections();
  read_rig(scenario);
  read_site(scenario);
  read_temperature(scenario);
  read_sensors(scenario);
  Section visit = section("visit");
  read_visit_noise(visit, scenario.visit);
  visit.refuse_rest();
  read_table(scenario);
  read_scalar(scenario);
  Section cage = section("cage"), reference = section("reference"), recording = section("recording");
  read_known_field(cage, reference, recording, scenario);
  read_covariates(scenario);
  read_effects(scenario);
  read_faults(scenario);
  for_each("vehicle", [&](Section& section) { scenario.vehicles.push_back(read_vehicle(section)); });
  for_each("magnet",
           [&](Section& section) { scenario.magnets.push_back(read_magnet(section, scenario.reach_m())); });
  for_each("gross", [&](Section& section) { scenario.gross.push_back(read_gross(section)); });
  return scenario;
}

std::vector<Mistake> Reader::mistakes() && {
  std::stable_sort(mistakes_.begin(), mistakes_.end(),
                   [](const Mistake& a, const Mistake& b) { return a.line < b.line; });
  return std::move(mistakes_);
}

}  // namespace

std::vector<Eigen::Vector3d> Scenario::places_m() const {
  if (!is_cross()) return positions_m;
  const double h = baseline_m / 2;
  return {{h, 0, 0}, {0, h, 0}, {-h, 0, 0}, {0, -h, 0}};
}

double Scenario::reach_m() const {
  constexpr double kLeast_m = 0.1;
  if (is_cross()) return baseline_m;
  double out = kLeast_m;
  for (const Eigen::Vector3d& x_m : positions_m) out = std::max(out, 2 * x_m.norm());
  return out;
}

Eigen::Vector3d Scenario::field_direction() const {
  const double inclination = inclination_deg * kDeg, declination = declination_deg * kDeg;
  return {std::cos(inclination) * std::cos(declination), std::cos(inclination) * std::sin(declination),
          std::sin(inclination)};
}

tl::expected<Scenario, std::vector<std::string>> parse_scenario(std::string_view text,
                                                                std::string_view file) {
  try {
    const toml::table root = toml::parse(text, file);
    Reader reader(root);
    Scenario scenario = reader.read();
    std::vector<std::string> lines;
    for (const Mistake& m : std::move(reader).mistakes())
      lines.push_back(fmt::format("{}:{}: {}", file, m.line, m.text));
    if (!lines.empty()) return tl::unexpected(std::move(lines));
    return scenario;
  } catch (const toml::parse_error& error) {
    return tl::unexpected(std::vector<std::string>{fmt::format(
        "{}:{}:{}: {}", file, error.source().begin.line, error.source().begin.column, error.description())});
  }
}

}  // namespace mgtd::rig
