// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "proto/standard_output.h"
#include "proto/version.h"
#include "tests/rig/config_text.h"
#include "tests/rig/fault.h"
#include "tests/rig/fault_client.h"
#include "tests/rig/operator.h"
#include "tests/rig/rig_server.h"
#include "tests/rig/scenario_help.h"
#include "tests/rig/seal.h"
#include "tests/rig/table_file.h"
#include "tests/rig/text_file.h"

namespace {

using namespace mgtd::rig;

constexpr const char* kDescription =
    R"(mgt-rig: a simulated rig on serial ports: four fluxgates (or 1 to 16) behind ObsDAQ digitisers, a three-axis table
(PI GCS 2) and a GSM-90 scalar magnetometer. Its physics is its own; what it hides, the estimator has to find.

  mgt-rig run --rig table6 --dir /tmp/rig --speed-up 30          ports in /tmp/rig until Ctrl-C
  mgt-rig config --rig table6 --dir /tmp/rig --speed-up 30 > mgtd.toml
  mgt-rig fault /tmp/rig unplug fluxgate2 for 3                  see mgt-rig fault --help
  mgt-rig table --scenario s.toml --poses run157 -o poses.csv    a pose table without ports and daemon
  mgt-rig truth --scenario s.toml                                what the rig really is, as JSON
  mgt-rig table --hide 1 --seal truth.sealed -o poses.csv        the blind game: find what it hides, then
  mgt-rig open truth.sealed                                      see whether you were right)";

struct Arguments {
  std::string scenario, rig = "table6", dir = "/tmp/mgt-rig", state, tcp = "127.0.0.1:7450", seal;
  int hide{0};
  std::uint64_t seed{1};
  double speed_up{1};
  TableFileOptions table;
  bool print_config{false};
  std::vector<std::string> words;
  std::vector<double> angles_deg;
  int arm{0};
  double warm_degC{0}, warm_tau_s{0}, warm_after_s{0}, coil_share{1};
  int warm_head{0};
  bool keep_warm{false};
  OperatorOptions hands;
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
    auto content = text_of_file(file);
    if (!content) return std::nullopt;
    text = *std::move(content);
  }
  auto scenario = parse_scenario(text, file);
  if (scenario) return *std::move(scenario);
  for (const std::string& line : scenario.error()) fmt::print(stderr, "{}\n", line);
  return std::nullopt;
}

/// Whether a file that is to be written is one that is read; it says so.
bool overwrites_input(const Arguments& args) {
  if (!args.seal.empty() && args.seal == args.table.output) {
    fmt::print(stderr, "mgt-rig: --seal and -o name one file: the table would overwrite the truth\n");
    return true;
  }
  for (const std::string& to : {args.table.output, args.seal}) {
    for (const std::string& from : {args.scenario, args.table.poses}) {
      std::error_code not_there;
      if (!std::filesystem::equivalent(to, from, not_there)) continue;
      fmt::print(stderr, "mgt-rig: {} is read by this command and would be overwritten: name another file\n",
                 to);
      return true;
    }
  }
  return false;
}

/// The answer, sealed before anything is measured.
bool seal_truth(const std::string& path, const Scenario& s) {
  std::random_device device;
  std::mt19937_64 random((std::uint64_t{device()} << 32U) ^ device());
  const Seal sealed = seal(truth_json(s), random);
  if (write_file(path, sealed.content) != 0) return false;
  fmt::print(stderr, "sealed in {}: sha256 {}\n", path, sealed.sha256);
  return true;
}

/// With what the command line wants hidden; sealed where it says so.
std::optional<Scenario> prepared(const Arguments& args, Scenario s) {
  if (overwrites_input(args)) return std::nullopt;
  if (args.hide > 0) {
    std::random_device device;
    std::mt19937_64 random((std::uint64_t{device()} << 32U) ^ device());
    s = with_hidden(std::move(s), args.hide, random);
  }
  if (!args.seal.empty() && !seal_truth(args.seal, s)) return std::nullopt;
  return s;
}

/// Only what stands behind a serial port can be run.
int run_rig(const Arguments& args, const Scenario& s) {
  if (args.print_config) return write_file("", args.config(s));
  if (s.reference || s.cage || s.recording) {
    fmt::print(stderr,
               "mgt-rig: [{}] is of a table and has no serial port; write one with: mgt-rig table "
               "--scenario {}\n",
               s.recording ? "recording"
               : s.cage    ? "cage"
                           : "reference",
               args.scenario);
    return 2;
  }
  const auto rig = prepared(args, s);
  return rig ? serve(*rig, {args.absolute_dir(), args.speed_up}) : 2;
}

int open(const Arguments& args) {
  const auto sealed = text_of_file(args.seal);
  if (!sealed) return 2;
  const auto truth = open_seal(*sealed);
  if (truth) return write_file("", truth->dump(1) + "\n");
  fmt::print(stderr, "mgt-rig: {}: {}\n", args.seal, truth.error());
  return 1;
}

int ask(const Arguments& args, const std::string& line) {
  const auto answer = ask_rig(args.dir, line);
  if (!answer) {
    fmt::print(stderr, "mgt-rig: no rig is running in {0}; start one with: mgt-rig run --dir {0}\n",
               args.dir);
    return 3;
  }
  const bool done = *answer == "ok" || answer->starts_with('{');
  if (done) {
    fmt::print("{}\n", *answer);
    return 0;
  }
  fmt::print(stderr, "mgt-rig: {}\n", *answer);
  return 1;
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

void add_game(CLI::App* command, Arguments& args) {
  command->add_option("--seal", args.seal, "write the truth to this file, sealed, and tell its hash");
  command->add_option("--hide", args.hide, "add so many effects at random")->check(CLI::Range(0, 5));
}

/// What is done to a rig by hand.
void add_hands(CLI::App& app, Arguments& args) {
  CLI::App* const mount =
      add(app, "mount", "put the array on the table in another way", args,
          [](const Arguments& a) { return ask(a, fmt::format("mount {}", fmt::join(a.angles_deg, " "))); });
  mount->add_option("DIR", args.dir, "directory of the rig")->required();
  mount->add_option("ANGLES", args.angles_deg, "azimuth, pitch and roll on the table in degrees")
      ->required()
      ->expected(3);
  CLI::App* const magnet = add(app, "magnet", "hold a magnet to the end of an arm", args,
                               [](const Arguments& a) { return ask(a, fmt::format("magnet {}", a.arm)); });
  magnet->add_option("DIR", args.dir, "directory of the rig")->required();
  magnet->add_option("ARM", args.arm, "number of its sensor; 0 puts it away")
      ->required()
      ->check(CLI::Range(0, 16));
  CLI::App* const warm =
      add(app, "warm", "warm the heads, and let them cool again", args, [](const Arguments& a) {
        return ask(a, fmt::format("{} {} {} {} {}", a.keep_warm ? "heat" : "warm", a.warm_degC, a.warm_tau_s,
                                  a.warm_head, a.warm_after_s));
      });
  warm->add_option("DIR", args.dir, "directory of the rig")->required();
  warm->add_option("DEGC", args.warm_degC, "at the peak")->required();
  warm->add_option("TAU", args.warm_tau_s, "simulated seconds to the peak")
      ->required()
      ->check(CLI::PositiveNumber);
  warm->add_option("--head", args.warm_head, "number of its sensor; 0 is all of them")
      ->capture_default_str()
      ->check(CLI::Range(0, 16));
  warm->add_option("--after", args.warm_after_s, "simulated seconds from now until it begins")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  warm->add_flag("--keep", args.keep_warm, "they stay warm; TAU is the time constant then");
  CLI::App* const coil = add(app, "coil", "change the site's field with a coil", args,
                             [](const Arguments& a) { return ask(a, fmt::format("coil {}", a.coil_share)); });
  coil->add_option("DIR", args.dir, "directory of the rig")->required();
  coil->add_option("SHARE", args.coil_share, "of the field that is left; 1 switches it off")
      ->required()
      ->check(CLI::PositiveNumber);
  CLI::App* const operate_command =
      add(app, "operate", "do what a daemon asks its operator to do, until the run ends", args,
          [](const Arguments& a) { return operate(a.hands); });
  operate_command->add_option("DIR", args.hands.dir, "directory of the rig")->required();
  operate_command->add_option("--control", args.hands.control, "control socket of the daemon")->required();
  operate_command->add_option("--error", args.hands.error_deg, "degrees to which things are set")
      ->capture_default_str();
  operate_command->add_flag("--magnet", args.hands.magnet, "hold a magnet where a magnet test asks for it");
  operate_command->add_option("--blunder", args.hands.blunder,
                              "misread the scale at this prompt, and once more");
}

void add_commands(CLI::App& app, Arguments& args) {
  CLI::App* const run = add_scenario(app, "run", "put the rig on serial ports until Ctrl-C", args, &run_rig);
  add_game(run, args);
  add_place(run, args);
  run->add_flag("--print-config", args.print_config, "print the mgtd.toml for this rig instead");
  add_place(add_scenario(app, "config", "print the mgtd.toml for this rig", args,
                         [](const Arguments& a, const Scenario& s) { return write_file("", a.config(s)); }),
            args);
  CLI::App* const poses = add_scenario(app, "table", "write a pose table straight from the physics", args,
                                       [](const Arguments& a, const Scenario& s) {
                                         auto rig = prepared(a, s);
                                         return rig ? write_table_file(a.table, *std::move(rig)) : 2;
                                       });
  add_game(poses, args);
  poses->add_flag("--samples", args.table.samples, "every sample instead of the distribution of the means");
  poses
      ->add_option("--poses", args.table.poses,
                   "run157 (36 standard and 121 random poses), octant157 (the field in one octant only), "
                   "grid5832, or a list of poses (CSV), as mgt next -o writes it")
      ->each([&args](const std::string&) { args.table.poses_given = true; })
      ->capture_default_str();
  poses->add_option("--begin", args.table.begin_s, "time of the rig's world at which the run starts, s (0)")
      ->check(CLI::Range(0.0, 1e7));
  poses->add_option("-o,--output", args.table.output, "file; standard output when absent");
  add_scenario(
      app, "truth", "print what the rig really is, as JSON", args,
      [](const Arguments&, const Scenario& s) { return write_file("", truth_json(s).dump(1) + "\n"); });
  add(app, "open", "show the truth in a sealed file", args, &open)
      ->add_option("FILE", args.seal, "sealed file")
      ->required();
  CLI::App* const fault =
      add(app, "fault", "make something go wrong on a running rig", args, [](const Arguments& a) {
        const std::string lasting = a.for_s > 0 ? fmt::format(" for {}", a.for_s) : "";
        return ask(a, fmt::format("{}{}", fmt::join(a.words, " "), lasting));
      });
  fault->add_option("DIR", args.dir, "directory of the rig")->required();
  fault->add_option("WORDS", args.words, kFaultUsage)->required();
  fault->add_option("--for", args.for_s, "simulated seconds, like the words 'for SECONDS'");
  add(app, "field", "the true gradient at a running rig's array, platform frame, as JSON", args,
      [](const Arguments& a) { return ask(a, "field"); })
      ->add_option("DIR", args.dir, "directory of the rig")
      ->required();
  add_hands(app, args);
  add(app, "status", "what a running rig is doing, as JSON", args,
      [](const Arguments& a) { return ask(a, "status"); })
      ->add_option("DIR", args.dir, "directory of the rig")
      ->required();
}

int run(int argc, char** argv) {
  CLI::App app{kDescription, "mgt-rig"};
  app.set_version_flag("--version", mgtd::version());
  app.require_subcommand(1);
  Arguments args;
  add_commands(app, args);
  app.footer(scenario_help());  // last: commands added later would take it over
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::ostringstream out;
    const int code = app.exit(error, out, std::cerr);
    fmt::print("{}", out.str());
    return code == 0 ? 0 : 2;
  }
  return args.code;
}

}  // namespace

int main(int argc, char** argv) {
  return mgtd::with_standard_output("mgt-rig", 2, [&] { return run(argc, argv); });
}
