// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/scenario.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <set>

#include "tests/rig/effects/axis_effects.h"
#include "tests/rig/effects/site_gradient.h"
#include "tests/rig/fault.h"

namespace mgtd::rig {
namespace {

/// Reads one table; remembers which keys were asked for, so that the others can be named.
class Section {
 public:
  Section(const toml::table* table, std::string name, std::string_view file, std::vector<std::string>& errors)
      : table_(table), name_(std::move(name)), file_(file), errors_(errors) {}

  template <class T>
  void read(std::string_view key, T& value) {
    const toml::node* const node = find(key);
    if (node == nullptr) return;
    if (const auto got = node->value<T>()) {
      value = *got;
    } else {
      complain(*node, fmt::format("{} has the wrong type", key));
    }
  }
  template <std::size_t N>
  void read(std::string_view key, std::array<double, N>& value) {
    const toml::node* const node = find(key);
    if (node == nullptr) return;
    const toml::array* const list = node->as_array();
    if (list == nullptr || list->size() != N)
      return complain(*node, fmt::format("{} must be a list of {} numbers", key, N));
    for (std::size_t i = 0; i < N; ++i) value.at(i) = list->get(i)->value<double>().value_or(0);
  }
  [[nodiscard]] bool has(std::string_view key) { return find(key) != nullptr; }
  void complain(const toml::node& where, const std::string& what) {
    errors_.push_back(fmt::format("{}:{}: [{}] {}", file_, where.source().begin.line, name_, what));
  }
  void refuse_rest() {
    if (table_ == nullptr) return;
    for (const auto& [key, node] : *table_) {
      if (!asked_.contains(std::string(key.str()))) {
        complain(node, fmt::format("unknown key '{}'; there are: {}", key.str(), fmt::join(asked_, ", ")));
      }
    }
  }
  [[nodiscard]] const toml::table* table() const { return table_; }

 private:
  const toml::node* find(std::string_view key) {
    asked_.insert(std::string(key));
    return table_ == nullptr ? nullptr : table_->get(key);
  }

  const toml::table* table_;
  std::string name_;
  std::string_view file_;
  std::vector<std::string>& errors_;
  std::set<std::string> asked_;
};

std::shared_ptr<Effect> make_effect(Section& s) {
  std::string name, where_text = "all";
  s.read("name", name);
  s.read("where", where_text);
  const auto where = Where::parse(where_text);
  if (!where)
    s.complain(*s.table(), fmt::format("where = '{}' must be all, s1 .. s4 or s1.x .. s4.z", where_text));
  const Where at = where.value_or(Where{});
  const auto amount = [&](std::string_view key) {
    double value = 0;
    if (!s.has(key)) s.complain(*s.table(), fmt::format("{} needs {}", name, key));
    s.read(key, value);
    return value;
  };
  if (name == "site.gradient") {
    std::array<double, 5> g{};
    if (!s.has("nT_per_m")) s.complain(*s.table(), "site.gradient needs nT_per_m = [xx, yy, xy, xz, yz]");
    s.read("nT_per_m", g);
    return std::make_shared<SiteGradient>(g);
  }
  if (name == "axis.offset.temperature")
    return std::make_shared<OffsetTemperature>(at, amount("nT_per_degC"));
  if (name == "axis.gain.temperature") return std::make_shared<GainTemperature>(at, amount("ppm_per_degC"));
  if (name == "axis.quadratic") return std::make_shared<Nonlinearity>(at, 2, amount("nT_at_F0"));
  if (name == "axis.cubic") return std::make_shared<Nonlinearity>(at, 3, amount("nT_at_F0"));
  if (name == "axis.hysteresis") {
    double width = 0.1;
    s.read("width", width);
    return std::make_shared<Hysteresis>(at, amount("h_nT"), width);
  }
  s.complain(
      *s.table(),
      fmt::format("no effect '{}'; there are: site.gradient, axis.offset.temperature, axis.gain.temperature, "
                  "axis.quadratic, axis.cubic, axis.hysteresis",
                  name));
  return nullptr;
}

class Reader {
 public:
  Reader(const toml::table& root, std::string_view file) : root_(root), file_(file) {}
  tl::expected<Scenario, std::vector<std::string>> read();

 private:
  Section section(std::string_view name) {
    const toml::node* const node = root_.get(name);
    return {node == nullptr ? nullptr : node->as_table(), std::string(name), file_, errors_};
  }
  void read_rig(Scenario& s);
  void read_site(Scenario& s);
  void read_instruments(Scenario& s);
  void read_lists(Scenario& s);

  const toml::table& root_;
  std::string_view file_;
  std::vector<std::string> errors_;
};

void Reader::read_rig(Scenario& s) {
  Section rig = section("rig");
  std::int64_t seed = 1;
  rig.read("name", s.name);
  rig.read("parameters", s.rig);
  rig.read("seed", seed);
  rig.read("baseline_m", s.baseline_m);
  s.seed = static_cast<std::uint64_t>(seed);
  if (const auto truth = rig_named(s.rig, s.seed)) {
    s.truth = *truth;
  } else {
    rig.complain(*rig.table(),
                 fmt::format("parameters = '{}' must be table3, table6, ideal or random", s.rig));
  }
  rig.refuse_rest();
}

void Reader::read_site(Scenario& s) {
  Section site = section("site");
  site.read("f_nT", s.f_nT);
  site.read("inclination_deg", s.inclination_deg);
  site.read("declination_deg", s.declination_deg);
  site.read("drift_nT_per_h", s.field_drift_nT_per_h);
  site.refuse_rest();
  Section temperature = section("temperature");
  temperature.read("start_degC", s.temperature.start_degC);
  temperature.read("ramp_degC_per_h", s.temperature.ramp_degC_per_h);
  temperature.read("head_degC", s.temperature.head_degC);
  temperature.refuse_rest();
}

void Reader::read_instruments(Scenario& s) {
  Section sensors = section("sensors");
  std::string kind = "gaussian";
  sensors.read("noise", kind);
  if (kind != "gaussian" && kind != "uniform")
    sensors.complain(*sensors.table(), "noise must be gaussian or uniform");
  s.noise = kind == "uniform" ? NoiseKind::uniform : NoiseKind::gaussian;
  sensors.read("noise_nT", s.noise_nT);
  sensors.read("rate_hz", s.rate_hz);
  sensors.read("range_V", s.range_V);
  sensors.read("uT_full_scale", s.uT_full_scale);
  sensors.read("palmacq", s.palmacq);
  sensors.read("common_trigger", s.common_trigger);
  sensors.read("oscillator_ppm", s.oscillator_ppm);
  sensors.refuse_rest();
  Section table = section("table");
  table.read("accuracy_deg", s.table_accuracy_deg);
  table.read("velocity_deg_per_s", s.table_velocity_deg_per_s);
  table.read("acceleration_deg_per_s2", s.table_acceleration_deg_per_s2);
  table.read("tilt_limit_deg", s.tilt_limit_deg);
  table.refuse_rest();
  Section scalar = section("scalar");
  scalar.read("present", s.scalar);
  scalar.read("noise_nT", s.scalar_noise_nT);
  scalar.refuse_rest();
}

void Reader::read_lists(Scenario& s) {
  if (const toml::node* node = root_.get("effect"); node != nullptr && node->is_array()) {
    for (const toml::node& item : *node->as_array()) {
      Section effect(item.as_table(), "[effect]", file_, errors_);
      if (auto made = make_effect(effect)) s.effects.push_back(std::move(made));
      effect.refuse_rest();
    }
  }
  if (const toml::node* node = root_.get("fault"); node != nullptr && node->is_array()) {
    for (const toml::node& item : *node->as_array()) {
      Section fault(item.as_table(), "[fault]", file_, errors_);
      TimedFault timed;
      fault.read("at_s", timed.at_s);
      fault.read("do", timed.text);
      fault.refuse_rest();
      if (const auto parsed = parse_fault(timed.text); !parsed) fault.complain(item, parsed.error());
      s.faults.push_back(std::move(timed));
    }
  }
  std::stable_sort(s.faults.begin(), s.faults.end(),
                   [](const auto& a, const auto& b) { return a.at_s < b.at_s; });
}

tl::expected<Scenario, std::vector<std::string>> Reader::read() {
  static const std::set<std::string_view> kSections{"rig",   "site",   "temperature", "sensors",
                                                    "table", "scalar", "effect",      "fault"};
  for (const auto& [key, node] : root_) {
    if (!kSections.contains(key.str())) {
      errors_.push_back(fmt::format("{}:{}: unknown section '{}'; there are: {}", file_,
                                    node.source().begin.line, key.str(), fmt::join(kSections, ", ")));
    }
  }
  Scenario scenario;
  read_rig(scenario);
  read_site(scenario);
  read_instruments(scenario);
  read_lists(scenario);
  if (!errors_.empty()) return tl::unexpected(std::move(errors_));
  return scenario;
}

}  // namespace

tl::expected<Scenario, std::vector<std::string>> parse_scenario(std::string_view text,
                                                                std::string_view file) {
  try {
    const toml::table root = toml::parse(text, file);
    return Reader(root, file).read();
  } catch (const toml::parse_error& error) {
    return tl::unexpected(std::vector<std::string>{fmt::format(
        "{}:{}:{}: {}", file, error.source().begin.line, error.source().begin.column, error.description())});
  }
}

nlohmann::json truth_json(const Scenario& s) {
  nlohmann::json sensors = nlohmann::json::array();
  for (const SensorTruth& t : s.truth) {
    sensors.push_back({{"theta_deg", t.theta_deg},
                       {"phi_deg", t.phi_deg},
                       {"psi_deg", t.psi_deg},
                       {"cx", t.scale[0]},
                       {"cy", t.scale[1]},
                       {"cz", t.scale[2]},
                       {"ix_nT", t.offset_nT[0]},
                       {"iy_nT", t.offset_nT[1]},
                       {"iz_nT", t.offset_nT[2]},
                       {"alpha_deg", t.alpha_deg},
                       {"beta_deg", t.beta_deg},
                       {"gamma_deg", t.gamma_deg}});
  }
  nlohmann::json effects = nlohmann::json::array();
  for (const auto& effect : s.effects) effects.push_back(effect->truth());
  return {
      {"schema", "mgt-rig.truth/1"},
      {"scenario", s.name},
      {"rig", s.rig},
      {"seed", s.seed},
      {"baseline_m", s.baseline_m},
      {"site",
       {{"f_nT", s.f_nT}, {"inclination_deg", s.inclination_deg}, {"declination_deg", s.declination_deg}}},
      {"noise_nT", s.noise_nT},
      {"table_accuracy_deg", s.table_accuracy_deg},
      {"sensors", sensors},
      {"effects", effects}};
}

}  // namespace mgtd::rig
