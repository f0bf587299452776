// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "daemon/cli/ask.h"
#include "daemon/cli/progress.h"
#include "proto/status_codec.h"

namespace mgtd::cli {
namespace {

std::string text_or(const nlohmann::json& object, const char* key, const char* otherwise) {
  const auto found = object.find(key);
  return found == object.end() || found->is_null() ? otherwise : found->get<std::string>();
}

void print_devices(const nlohmann::json& devices) {
  fmt::print("\n{:<8} {:<8} {:>10} {:>9}  {}\n", "device", "state", "frames", "rejected", "");
  for (const auto& d : devices) {
    std::uint64_t rejected = 0;
    for (const auto& [reason, count] : d.at("rejected").items()) rejected += count.get<std::uint64_t>();
    const std::string said = d.at("state") == "live" ? text_or(d, "identity", "") : text_or(d, "detail", "");
    fmt::print("{:<8} {:<8} {:>10} {:>9}  {}\n", d.at("name").get<std::string>(),
               d.at("state").get<std::string>(), d.at("frames").get<std::uint64_t>(), rejected, said);
    if (!d.at("balanced").get<bool>()) fmt::print("         bytes do not add up: please report this\n");
  }
}

void print_run(const nlohmann::json& object) {
  const auto run = run_status_from_json(object);
  if (!run || run->run_id.empty()) {
    fmt::print("\nrun       none\n");
    return;
  }
  fmt::print("\nrun       {}\n          {}\n          {}\n", run->run_id, progress_line(*run, 100),
             run->message);
  for (const Check& check : run->checks) {
    if (!check.passed)
      fmt::print("          failed: {}: {}; limit {}; {}\n", check.name, check.measured, check.limit,
                 check.remedy);
  }
  if (!run->proposed.empty())
    fmt::print("          proposed: {} (mgt calibrations accept {})\n", run->proposed, run->proposed);
}

int run_status(const Session& session) {
  const auto status = ask(session, ControlCommand::status);
  if (!status) return report(session, status.error());
  if (session.json) {
    print_json(*status);
    return 0;
  }
  const auto& s = *status;
  const auto& sampler = s.at("sampler");
  fmt::print("rig       {} ({})\n", s.at("rig").get<std::string>(), s.at("software").get<std::string>());
  fmt::print("up        {}\n", duration_text(s.at("uptime_s").get<double>()));
  fmt::print("stream    {} epochs, {} missing", sampler.at("epochs").get<std::uint64_t>(),
             sampler.at("gaps").get<std::uint64_t>());
  if (!sampler.at("rate_hz").is_null()) fmt::print(", {:.2f} a second", sampler.at("rate_hz").get<double>());
  if (!sampler.at("skew_bound_s").is_null())
    fmt::print(", skew below {:.3f} ms", 1e3 * sampler.at("skew_bound_s").get<double>());
  fmt::print("\ncalibr.   {}\n", text_or(s, "cal", "none: the stream is raw and says so"));
  fmt::print("journal   {}\n", s.at("journal").at("state").get<std::string>());
  print_devices(s.at("devices"));
  print_run(s.at("run"));
  return 0;
}

}  // namespace

void add_status(CLI::App& app, Session& session) {
  add_command(app, session, "status", "devices, stream, calibration and run of the daemon",
              [&session] { return run_status(session); });
}

}  // namespace mgtd::cli
