// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/rig/config_text.h"
#include "tests/rig/effect_list.h"
#include "tests/rig/fault.h"
#include "tests/rig/fault_client.h"
#include "tests/rig/pose_writer.h"
#include "tests/rig/rig_server.h"

namespace {

using namespace mgtd::rig;

constexpr const char* kDescription =
    R"(mgt-rig: a simulated rig on serial ports: four fluxgates behind ObsDAQ digitisers, a three-axis table (PI GCS 2)
and a GSM-90 scalar magnetometer. Its physics is its own; what it hides, the estimator has to find.

  mgt-rig run --rig table6 --dir /tmp/rig --speed-up 30          ports in /tmp/rig until Ctrl-C
  mgt-rig config --rig table6 --dir /tmp/rig --speed-up 30 > mgtd.toml
  mgt-rig fault /tmp/rig unplug fluxgate2 for 3                  see mgt-rig fault --help
  mgt-rig table --scenario s.toml --poses run157 -o poses.csv    a pose table without ports and daemon
  mgt-rig truth --scenario s.toml                                what the rig really is, as JSON)";

constexpr const char* kScenarioHelp =
    R"(A scenario is a TOML file; every key has a default:
  [rig]          name, parameters (table3, table6, ideal, random), seed, baseline_m
  [s1] .. [s4]   theta_deg phi_deg psi_deg cx cy cz ix_nT iy_nT iz_nT alpha_deg beta_deg gamma_deg, where they differ
                 from the named rig; mounting = "y -x z": where the sensor's x, y, z point on the platform
  [site]         f_nT, inclination_deg, declination_deg, drift_nT_per_h, diurnal_nT, diurnal_period_h
  [temperature]  start_degC, ramp_degC_per_h, head_degC = [4], pulse_degC, pulse_at_s, pulse_tau_s, pulse_head
  [sensors]      noise (gaussian, uniform), noise_nT (sd or half width of one sample), rate_hz, range_V,
                 uT_full_scale, palmacq, common_trigger, autostart, oscillator_ppm
  [table]        accuracy_deg, velocity_deg_per_s, acceleration_deg_per_s2, tilt_limit_deg
  [scalar]       present, noise_nT, period_s, bad_every
  [[fault]]      at_s, do = "unplug fluxgate2 for 3"
  [[effect]]     name and coefficients; where = all, s1 .. s4, s1.x .. s4.z (default all):
)";

std::string footer() {
  std::string out = kScenarioHelp;
  for (const std::string& line : effect_help()) out += "    " + line + "\n";
  return out +
         "Exit code: 0 done, 1 the rig refused, 2 usage or a scenario with mistakes, 3 no rig is running "
         "there.";
}

struct Arguments {
  std::string scenario, rig = "table6", dir = "/tmp/mgt-rig", state, output, poses = "run157",
                        tcp = "127.0.0.1:7450";
  std::uint64_t seed{1};
  double speed_up{1};
  bool print_config{false};
  std::vector<std::string> words;
  double for_s{0};
  int code{0};

  [[nodiscard]] std::string absolute_dir() const { return std::filesystem::absolute(dir).lexically_normal(); }
  [[nodiscard]] std::string config(const Scenario& s) const {
    const std::string kept =
        state.empty() ? absolute_dir() + "/state" : std::string(std::filesystem::absolute(state));
    return config_text(s, absolute_dir(), kept, speed_up, tcp);
  }
};

/// The scenario file, or a clean rig by name. Nothing when it has mistakes: they are on stderr.
std::optional<Scenario> load(const Arguments& args) {
  std::string text =
      fmt::format("[rig]\nname = \"{0}\"\nparameters = \"{0}\"\nseed = {1}\n", args.rig, args.seed);
  std::string file = "--rig";
  if (!args.scenario.empty()) {
    file = args.scenario;
    std::ifstream in(file);
    std::ostringstream content;
    if (!in || !(content << in.rdbuf())) {
      fmt::print(stderr, "mgt-rig: {} cannot be read\n", file);
      return std::nullopt;
    }
    text = content.str();
  }
  auto scenario = parse_scenario(text, file);
  if (scenario) return *std::move(scenario);
  for (const std::string& line : scenario.error()) fmt::print(stderr, "{}\n", line);
  return std::nullopt;
}

int write(const std::string& path, const std::string& content) {
  if (path.empty()) {
    fmt::print("{}", content);
    return 0;
  }
  std::ofstream out(path, std::ios::binary);
  if (out << content << std::flush) return 0;
  fmt::print(stderr, "mgt-rig: {} cannot be written\n", path);
  return 2;
}

int ask(const Arguments& args, const std::string& line) {
  const auto answer = ask_rig(args.dir, line);
  if (!answer) {
    fmt::print(stderr, "mgt-rig: no rig is running in {0}; start one with: mgt-rig run --dir {0}\n",
               args.dir);
    return 3;
  }
  const bool done = *answer == "ok" || answer->starts_with('{');
  fmt::print(done ? stdout : stderr, "{}\n", *answer);
  return done ? 0 : 1;
}

template <class Body>
CLI::App* add(CLI::App& app, const char* name, const char* what, Arguments& args, Body body) {
  CLI::App* const command = app.add_subcommand(name, what);
  command->callback([&args, body] { args.code = body(args); });
  return command;
}

/// A command on a scenario.
template <class Body>
CLI::App* add_scenario(CLI::App& app, const char* name, const char* what, Arguments& args, Body body) {
  CLI::App* const command = add(app, name, what, args, [body](const Arguments& a) {
    const auto scenario = load(a);
    return scenario ? body(a, *scenario) : 2;
  });
  CLI::Option* const file =
      command->add_option("--scenario", args.scenario, "scenario file (mgt-rig --help)");
  command->add_option("--rig", args.rig, "a clean rig instead: table3, table6, ideal, random")
      ->capture_default_str()
      ->excludes(file);
  command->add_option("--seed", args.seed, "of that rig")->capture_default_str()->excludes(file);
  return command;
}

void add_place(CLI::App* command, Arguments& args) {
  command->add_option("--dir", args.dir, "where the ports appear")->capture_default_str();
  command->add_option("--speed-up", args.speed_up, "simulated seconds per second; the daemon needs the same")
      ->check(CLI::Range(0.1, 1000.0))
      ->capture_default_str();
  command->add_option("--state", args.state,
                      "where the daemon shall keep runs, calibrations and sockets [DIR/state]");
  command->add_option("--tcp", args.tcp, "address of the daemon's stream")->capture_default_str();
}

void add_commands(CLI::App& app, Arguments& args) {
  CLI::App* const run = add_scenario(
      app, "run", "put the rig on serial ports until Ctrl-C", args,
      [](const Arguments& a, const Scenario& s) {
        return a.print_config ? write("", a.config(s)) : serve(s, {a.absolute_dir(), a.speed_up});
      });
  add_place(run, args);
  run->add_flag("--print-config", args.print_config, "print the mgtd.toml for this rig instead");
  add_place(add_scenario(app, "config", "print the mgtd.toml for this rig", args,
                         [](const Arguments& a, const Scenario& s) { return write("", a.config(s)); }),
            args);
  CLI::App* const table = add_scenario(
      app, "table", "write a pose table straight from the physics", args,
      [](const Arguments& a, const Scenario& s) {
        return write(a.output,
                     pose_table_csv(s, a.poses == "grid5832" ? PoseSet::grid5832 : PoseSet::run157));
      });
  table->add_option("--poses", args.poses, "run157 (36 standard and 121 random poses) or grid5832")
      ->check(CLI::IsMember({"run157", "standard+random", "grid5832"}))
      ->capture_default_str();
  table->add_option("-o,--output", args.output, "file; standard output when absent");
  add_scenario(app, "truth", "print what the rig really is, as JSON", args,
               [](const Arguments&, const Scenario& s) { return write("", truth_json(s).dump(1) + "\n"); });
  CLI::App* const fault =
      add(app, "fault", "make something go wrong on a running rig", args, [](const Arguments& a) {
        const std::string lasting = a.for_s > 0 ? fmt::format(" for {}", a.for_s) : "";
        return ask(a, fmt::format("{}{}", fmt::join(a.words, " "), lasting));
      });
  fault->add_option("DIR", args.dir, "directory of the rig")->required();
  fault->add_option("WORDS", args.words, kFaultUsage)->required();
  fault->add_option("--for", args.for_s, "simulated seconds, like the words 'for SECONDS'");
  add(app, "status", "what a running rig is doing, as JSON", args,
      [](const Arguments& a) { return ask(a, "status"); })
      ->add_option("DIR", args.dir, "directory of the rig")
      ->required();
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{kDescription, "mgt-rig"};
  app.footer(footer());
  app.set_version_flag("--version", MGTD_VERSION);
  app.require_subcommand(1);
  Arguments args;
  add_commands(app, args);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return args.code;
}
