// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <fstream>
#include <sstream>

#include "tests/rig/config_text.h"
#include "tests/rig/fault.h"
#include "tests/rig/pose_writer.h"
#include "tests/rig/rig_server.h"

namespace {

using namespace mgtd::rig;

constexpr const char* kDescription =
    "mgt-rig: a simulated rig on serial ports: four fluxgates behind ObsDAQ digitisers, a three-axis table "
    "(PI GCS 2), a GSM-90\n\n"
    "  mgt-rig run --rig table6 --dir /tmp/rig --speed-up 30          ports in /tmp/rig until Ctrl-C\n"
    "  mgt-rig config --rig table6 --dir /tmp/rig --speed-up 30 --state /tmp/state > mgtd.toml\n"
    "  mgt-rig fault /tmp/rig unplug fluxgate2 for 3                  also: garbage, torn, freeze, stall, "
    "restore\n"
    "  mgt-rig table --scenario s.toml --poses run157 -o poses.csv    a pose table without ports and daemon\n"
    "  mgt-rig truth --scenario s.toml                                what the rig really is, as JSON\n\n"
    "A scenario (TOML): [rig] parameters, seed, baseline_m; [site] f_nT, inclination_deg, declination_deg, "
    "drift_nT_per_h;\n"
    "[temperature] start_degC, ramp_degC_per_h, head_degC; [sensors] noise, noise_nT, rate_hz, range_V, "
    "uT_full_scale, palmacq,\n"
    "common_trigger, oscillator_ppm; [table] accuracy_deg, velocity_deg_per_s, acceleration_deg_per_s2, "
    "tilt_limit_deg; [scalar] present, noise_nT;\n"
    "[[effect]] name, where, coefficient; [[fault]] at_s, do.";

struct Arguments {
  std::string scenario, rig = "table6", dir = "/tmp/mgt-rig", state, output, poses = "run157",
                        tcp = "127.0.0.1:7450";
  std::uint64_t seed{1};
  double speed_up{1};
  std::vector<std::string> words;
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

void add_scenario(CLI::App* command, Arguments& args) {
  command->add_option("--scenario", args.scenario, "scenario file");
  command->add_option("--rig", args.rig, "a clean rig instead: table3, table6, ideal, random")
      ->capture_default_str();
  command->add_option("--seed", args.seed, "of that rig")->capture_default_str();
}

void add_place(CLI::App* command, Arguments& args) {
  command->add_option("--dir", args.dir, "where the ports appear")->capture_default_str();
  command->add_option("--speed-up", args.speed_up, "simulated seconds per second; the daemon needs the same")
      ->check(CLI::Range(0.1, 1000.0))
      ->capture_default_str();
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{kDescription, "mgt-rig"};
  app.set_version_flag("--version", MGTD_VERSION);
  app.require_subcommand(1);
  Arguments args;
  int code = 0;
  const auto with_scenario = [&](auto body) {
    return [&args, &code, body] {
      const auto scenario = load(args);
      code = scenario ? body(*scenario) : 2;
    };
  };
  CLI::App* const run = app.add_subcommand("run", "put the rig on serial ports until Ctrl-C");
  add_scenario(run, args);
  add_place(run, args);
  run->callback(with_scenario([&](const Scenario& s) { return serve(s, {args.dir, args.speed_up}); }));
  CLI::App* const config = app.add_subcommand("config", "print the mgtd.toml for this rig");
  add_scenario(config, args);
  add_place(config, args);
  config->add_option("--state", args.state, "where the daemon keeps runs, calibrations and sockets")
      ->required();
  config->add_option("--tcp", args.tcp, "address of the stream")->capture_default_str();
  config->callback(with_scenario([&](const Scenario& s) {
    return write("", config_text(s, args.dir, args.state, args.speed_up, args.tcp));
  }));
  CLI::App* const table = app.add_subcommand("table", "write a pose table straight from the physics");
  add_scenario(table, args);
  table->add_option("--poses", args.poses, "run157 or grid5832")
      ->check(CLI::IsMember({"run157", "grid5832"}))
      ->capture_default_str();
  table->add_option("-o,--output", args.output, "file; standard output when absent");
  table->callback(with_scenario([&](const Scenario& s) {
    return write(args.output,
                 pose_table_csv(s, args.poses == "run157" ? PoseSet::run157 : PoseSet::grid5832));
  }));
  CLI::App* const truth = app.add_subcommand("truth", "print what the rig really is, as JSON");
  add_scenario(truth, args);
  truth->callback(with_scenario([](const Scenario& s) { return write("", truth_json(s).dump(1) + "\n"); }));
  CLI::App* const fault = app.add_subcommand("fault", "make something go wrong on a running rig");
  fault->add_option("DIR", args.dir, "directory of the rig")->required();
  fault->add_option("WORDS", args.words, "unplug|garbage|torn|freeze|stall|restore PORT [for SECONDS]")
      ->required();
  fault->callback([&] { code = send_fault(args.dir, fmt::format("{}", fmt::join(args.words, " "))); });
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return code;
}
