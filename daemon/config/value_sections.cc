// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/value_sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "calib/effects/library/library.h"
#include "daemon/config/tcp_address.h"

namespace mgtd::daemon::config {
namespace {

using drivers::Settings;

void require(Settings& s, std::string_view key, bool ok, std::string_view rule) {
  if (!ok) s.object(key, fmt::format("must be {}", rule));
}

void read_rig(Settings& s, Config& config) {
  config.rig_name = s.text("name", config.rig_name);
  config.baseline_m = s.number("baseline_m", config.baseline_m);
  require(s, "baseline_m", is_baseline(config.baseline_m), "between 0.05 and 10 m");
  config.rate_hz = s.number("rate_hz", config.rate_hz);
  require(s, "rate_hz", config.rate_hz > 0 && config.rate_hz <= 1000, "above 0 and at most 1000 Hz");
}

std::optional<double> optional_number(Settings& s, std::string_view key) {
  const double value = s.number(key, 0.0);
  return s.has(key) ? std::optional(value) : std::nullopt;
}

void read_site(Settings& s, Config& config) {
  config.site.field_nT = optional_number(s, "field_nT");
  require(s, "field_nT",
          !config.site.field_nT || (*config.site.field_nT > 1000 && *config.site.field_nT < 200'000),
          "a total field in nT, 1000 to 200000");
  config.site.field_sd_nT = s.number("field_sd_nT", config.site.field_sd_nT);
  require(s, "field_sd_nT", config.site.field_sd_nT >= 0, "0 nT or more");
  config.site.inclination_deg = optional_number(s, "inclination_deg");
  require(s, "inclination_deg", !config.site.inclination_deg || std::abs(*config.site.inclination_deg) <= 90,
          "-90 to 90 deg");
  config.site.declination_deg = optional_number(s, "declination_deg");
  config.site.table_sd_deg = s.number("table_sd_deg", config.site.table_sd_deg);
  require(s, "table_sd_deg", config.site.table_sd_deg > 0 && config.site.table_sd_deg < 10,
          "above 0 and below 10 deg");
}

void read_calibration(Settings& s, Config& config) {
  config.effects = s.texts("effects");
  for (const std::string& effect : config.effects) {
    if (const auto known = calib::effects::library::make_effect(effect); !known)
      s.object("effects", known.error().message);
  }
}

void read_disturbance(Settings& s, RunDefaults& r) {
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

void read_run(Settings& s, Config& config) {
  RunDefaults& r = config.run;
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
}

void read_console(Settings& s, Config& config) {
  config.console.listen = s.text("listen", config.console.listen);
  if (const auto address = parse_tcp_address(config.console.listen);
      !config.console.listen.empty() && !address)
    s.object("listen", address.error().text());
  config.console.hosts = s.texts("hosts");
  for (const std::string& host : config.console.hosts)
    require(s, "hosts", !host.empty() && host.find_first_of("/ \t@") == std::string::npos,
            "names or addresses of this computer without http:// and port, like \"rig7.local\"");
  const std::string from = s.text("control_from", "loopback");
  require(s, "control_from", from == "loopback" || from == "network", "\"loopback\" or \"network\"");
  config.console.control_from_network = from == "network";
}

void read_store(Settings& s, Config& config) {
  config.store.dir = s.text("dir", config.store.dir);
  config.store.journal = s.boolean("journal", config.store.journal);
  config.store.journal_mb = s.integer("journal_mb", config.store.journal_mb);
  require(s, "journal_mb", config.store.journal_mb == 0 || config.store.journal_mb >= 16,
          "16 MB or more, or 0 for no limit");
  config.store.journal_days = s.number("journal_days", config.store.journal_days);
  require(s, "journal_days", config.store.journal_days >= 0 && config.store.journal_days <= 36'500,
          "0 (no limit) to 36500 days");
  config.store.ring_mb = s.integer("ring_mb", config.store.ring_mb);
  require(s, "ring_mb",
          config.store.ring_mb == 0 || (config.store.ring_mb >= 1 && config.store.ring_mb <= 1'000'000),
          "1 to 1000000 MB, or 0 for none");
  config.store.reserve_mb = s.integer("reserve_mb", config.store.reserve_mb);
  require(s, "reserve_mb", config.store.reserve_mb >= 0, "0 MB or more");
}

void read_stream(Settings& s, Config& config) {
  config.stream.tcp = s.text("tcp", config.stream.tcp);
  if (const auto address = parse_tcp_address(config.stream.tcp); !config.stream.tcp.empty() && !address)
    s.object("tcp", address.error().text());
  config.stream.unix_path = s.text("unix", config.stream.unix_path);
}

void read_control(Settings& s, Config& config) {
  config.control.unix_path = s.text("unix", config.control.unix_path);
  const std::string mode = s.text("mode", "0660");
  const bool octal =
      mode.size() <= 4 && !mode.empty() && mode.find_first_not_of("01234567") == std::string::npos;
  require(s, "mode", octal, "file permissions in octal, like \"0660\"");
  if (octal) config.control.mode = static_cast<int>(std::strtol(mode.c_str(), nullptr, 8));
}

void read_daemon(Settings& s, Config& config) {
  config.log_level = s.text("log_level", config.log_level);
  static constexpr std::array<std::string_view, 4> kLogLevels{"debug", "info", "warn", "error"};
  require(s, "log_level",
          std::find(kLogLevels.begin(), kLogLevels.end(), config.log_level) != kLogLevels.end(),
          "debug, info, warn or error");
  config.speed_up = s.number("speed_up", config.speed_up);
  require(s, "speed_up", config.speed_up >= 1 && config.speed_up <= 1000, "1 (real time) to 1000");
}

constexpr std::array<ValueSection, 9> kValueSections{{{"rig", read_rig},
                                                      {"site", read_site},
                                                      {"calibration", read_calibration},
                                                      {"run", read_run},
                                                      {"store", read_store},
                                                      {"stream", read_stream},
                                                      {"control", read_control},
                                                      {"console", read_console},
                                                      {"daemon", read_daemon}}};

}  // namespace

std::span<const ValueSection> value_sections() { return kValueSections; }

bool is_baseline(double baseline_m) { return baseline_m >= 0.05 && baseline_m <= 10; }

}  // namespace mgtd::daemon::config
