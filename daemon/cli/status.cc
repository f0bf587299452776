// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "calib/poses/pose_columns.h"
#include "daemon/cli/age_text.h"
#include "daemon/cli/ask.h"
#include "daemon/cli/progress.h"
#include "daemon/run/preflight.h"
#include "proto/status_codec.h"

namespace mgtd::daemon::cli {
namespace {

std::string text_or(const nlohmann::json& object, const char* key, const char* otherwise) {
  const auto found = object.find(key);
  return found == object.end() || found->is_null() ? otherwise : found->get<std::string>();
}

/// Of a daemon of an earlier version the key is missing.
template <class Shown>
std::string number_or(const nlohmann::json& object, const char* key, const char* otherwise, Shown shown) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number() ? shown(found->template get<double>()) : otherwise;
}

using Text = std::back_insert_iterator<std::string>;

void write_devices(Text to, const nlohmann::json& devices) {
  constexpr auto kRow = "{:<8} {:<9} {:>7} {:>10} {:>8} {:>8}  {}\n";
  fmt::format_to(to, "\n");
  fmt::format_to(to, kRow, "device", "state", "for", "frames", "a second", "rejected", "");
  for (const auto& d : devices) {
    std::uint64_t rejected = 0;
    for (const auto& [reason, count] : d.at("rejected").items()) rejected += count.get<std::uint64_t>();
    const std::string said = d.at("state") == "live" ? text_or(d, "identity", "") : text_or(d, "detail", "");
    const std::string since = number_or(d, "state_since_s", "", age_text);
    const std::string rate = number_or(d, "rate_hz", "", [](double hz) { return fmt::format("{:.1f}", hz); });
    fmt::format_to(to, kRow, d.at("name").get<std::string>(), d.at("state").get<std::string>(), since,
                   d.at("frames").get<std::uint64_t>(), rate, rejected, said);
    if (const auto clock = d.find("clock"); clock != d.end() && !clock->is_null())
      if (const std::string trouble = text_or(*clock, "trouble", ""); !trouble.empty())
        fmt::format_to(to, "         {}\n", trouble);
  }
}

/// What the auxiliary inputs and thermometers measure now.
void write_inputs(Text to, const nlohmann::json& inputs) {
  constexpr double kNow_s = 10;
  if (inputs.empty()) return;
  fmt::format_to(to, "\n{:<12} {:<8} {:>12}\n", "input", "of", "value");
  for (const auto& input : inputs) {
    const std::string of =
        fmt::format("{} {}", input.at("device").get<std::string>(), input.at("input").get<std::string>());
    const auto &value = input.at("value"), &age = input.at("age_s");
    const std::string unit = text_or(input, "unit", "");
    const std::string ago = age.is_null() ? std::string() : duration_text(age.get<double>());
    const std::string said =
        !value.is_number() ? fmt::format("{:>12} not measured {}", "--", ago.empty() ? "yet" : "for " + ago)
        : age.get<double>() > kNow_s ? fmt::format("{:>12.4f} {}, {} ago", value.get<double>(), unit, ago)
                                     : fmt::format("{:>12.4f} {}", value.get<double>(), unit);
    fmt::format_to(to, "{:<12} {:<8} {}\n", input.at("name").get<std::string>(), of, said);
  }
}

void write_run(Text to, const nlohmann::json& object) {
  const auto run = run_status_from_json(object);
  if (!run || run->run_id.empty()) {
    fmt::format_to(to, "\nrun       none\n");
    return;
  }
  fmt::format_to(to, "\nrun       {}\n          {}\n          {}\n", run->run_id, progress_line(*run, 100),
                 run->message);
  for (const Check& check : run->checks) {
    if (!check.passed)
      fmt::format_to(to, "          failed: {}: {}; limit {}; {}\n", check.name, check.measured, check.limit,
                     check.remedy);
  }
  if (!run->proposed.empty())
    fmt::format_to(to, "          proposed: {} (mgt calibrations accept {})\n", run->proposed, run->proposed);
}

bool all_live(const nlohmann::json& status) {
  for (const auto& device : status.at("devices")) {
    if (device.at("state") != "live") return false;
  }
  return !status.at("sampler").at("rate_hz").is_null();
}

/// The status once every device is live and samples come, or as it is when the time to wait is over.
Result<nlohmann::json> status_after(const Session& session, double patience_s) {
  const auto deadline = std::chrono::steady_clock::now() + from_seconds(patience_s);
  while (true) {
    auto status = ask(session, ControlCommand::status);
    if ((status && all_live(*status)) || std::chrono::steady_clock::now() >= deadline) return status;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
}

/// Tells what an operator must know of the active calibration beside its id.
void write_calibration(Text to, const nlohmann::json& s) {
  const auto& use = s.at("calibration");
  if (const std::string conditions = conditions_text(use); !conditions.empty())
    fmt::format_to(to, "          {}\n", conditions);
  if (use.at("forced") == true) fmt::format_to(to, "          it failed its checks and was forced\n");
  for (const auto& e : use.at("left_out"))
    fmt::format_to(to, "          not corrected: {}, {} is not measured\n", e.at("effect").get<std::string>(),
                   e.at("lacks").get<std::string>());
  const auto& criticism = s.at("criticism");
  const std::string state = criticism.at("state");
  if (state == "none") return;
  fmt::format_to(to, "judged    {}\n", state);
  if (criticism.at("measured").get<std::string>().empty()) return;
  fmt::format_to(to, "          {}\n          limit: {}\n          {}\n",
                 criticism.at("measured").get<std::string>(), criticism.at("limit").get<std::string>(),
                 criticism.at("remedy").get<std::string>());
}

std::string holder_name(const nlohmann::json& holder) {
  const std::string via = holder.value("via", "");
  return via.empty() ? fmt::format("pid {} (uid {})", holder.at("pid").get<std::int64_t>(),
                                   holder.at("uid").get<std::int64_t>())
                     : via;
}

/// Who listens, who was sent away, who has control.
void write_clients(Text to, const nlohmann::json& s) {
  const auto& stream = s.at("stream");
  fmt::format_to(to, "clients   {} of the stream", stream.at("clients").get<std::uint64_t>());
  if (stream.at("dropped") != 0)
    fmt::format_to(to, ", {} sent away (the last: {})", stream.at("dropped").get<std::uint64_t>(),
                   stream.at("last_drop").get<std::string>());
  const auto& control = s.at("control");
  const auto& holder = control.at("holder");
  if (!holder.is_null())
    fmt::format_to(to, "; control is with {} since {}", holder_name(holder),
                   holder.at("since").get<std::string>());
  if (control.at("dropped") != 0)
    fmt::format_to(to, "\n          {}", control.at("last_drop").get<std::string>());
  fmt::format_to(to, "\n");
}

/// Of a daemon of an earlier version: four, all that it knew.
std::size_t sensors_of(const nlohmann::json& s) {
  const auto array = s.find("array");
  return array == s.end() ? kSensorCount : array->at("sensors").get<std::size_t>();
}

/// How many sensors there are and what they tell; the reasons are in --json.
void write_array(Text to, const nlohmann::json& array) {
  const std::string tells = array.at("tells");
  fmt::format_to(to, "array     {}: {}\n", calib::poses::counted(array.at("sensors").get<std::size_t>()),
                 tells.substr(0, tells.find("; ")));
}

/// Explains a wide skew bound or many gaps. The limit of the skew is that of a run's preflight, which has
/// none to speak of faster than real time.
void write_stream_remarks(Text to, const nlohmann::json& sampler, double speed_up) {
  constexpr double kMostMissing = 0.01;
  const double most_skew_s = run::PreflightConfig{}.max_skew_s;
  const double skew_s = sampler.at("skew_bound_s").is_null() ? 0 : sampler.at("skew_bound_s").get<double>();
  if (skew_s > most_skew_s && speed_up > 1)
    fmt::format_to(to,
                   "\n          that is the delay of this computer times the speed of the simulation; a run "
                   "accepts up to 60 s");
  else if (skew_s > most_skew_s)
    fmt::format_to(to,
                   "\n          the sample times are less certain than a run accepts (limit {:.0f} ms): this "
                   "passes within minutes of a start; if not, look at the load of this computer, and lower "
                   "the converters' latency timers and state them in delivery_s",
                   1e3 * most_skew_s);
  const double missing = sampler.at("gaps").get<double>();
  const double share = missing / std::max(1.0, missing + sampler.at("epochs").get<double>());
  if (share > kMostMissing)
    fmt::format_to(
        to,
        "\n          {:.0f} % are missing since the start, because devices are or were not live; mgt watch "
        "names them",
        100 * share);
}

void write_recording(Text to, const char* what, const nlohmann::json& recording) {
  fmt::format_to(to, "{:<9} {}", what, recording.at("state").get<std::string>());
  if (recording.at("state") != "off")
    fmt::format_to(to, ", {:.1f} MB on disk since the start", recording.at("bytes").get<double>() / 1e6);
  if (recording.at("bytes_lost") > 0)
    fmt::format_to(to, ", {:.1f} MB lost", recording.at("bytes_lost").get<double>() / 1e6);
  fmt::format_to(to, "\n");
  if (const std::string why = recording.at("why"); !why.empty()) fmt::format_to(to, "          {}\n", why);
}

/// Tells how many bytes each device sent and what became of them.
void write_bytes(Text to, const nlohmann::json& devices) {
  constexpr auto kRow = "{:<8} {:>11} = {:>11} + {:>8} + {:>7} + {:>7}  {}\n";
  to = fmt::format_to(to, "\n");
  fmt::format_to(to, kRow, "bytes", "in", "in frames", "rejected", "resync", "pending", "rejected for");
  for (const auto& d : devices) {
    std::string reasons;
    for (const auto& [reason, count] : d.at("rejected").items()) {
      if (count > 0) reasons += fmt::format("{}{} {}", reasons.empty() ? "" : ", ", reason, count.dump());
    }
    const auto bytes = [&](const char* key) { return d.at(key).get<std::uint64_t>(); };
    fmt::format_to(to, kRow, d.at("name").get<std::string>(), bytes("bytes_in"), bytes("bytes_in_frames"),
                   bytes("bytes_rejected"), bytes("bytes_resync"), bytes("bytes_pending"), reasons);
    if (!d.at("balanced").get<bool>())
      fmt::format_to(to, "         these do not add up: please report this\n");
  }
}

void write_status(Text to, const nlohmann::json& s) {
  const auto& sampler = s.at("sampler");
  fmt::format_to(to, "rig       {} ({})\n", s.at("rig").get<std::string>(),
                 s.at("software").get<std::string>());
  if (const auto array = s.find("array"); array != s.end()) write_array(to, *array);
  fmt::format_to(to, "up        {}\n", duration_text(s.at("uptime_s").get<double>()));
  fmt::format_to(to, "stream    {} epochs, {} missing", sampler.at("epochs").get<std::uint64_t>(),
                 sampler.at("gaps").get<std::uint64_t>());
  if (!sampler.at("rate_hz").is_null())
    fmt::format_to(to, ", {:.2f} a second", sampler.at("rate_hz").get<double>());
  if (!sampler.at("skew_bound_s").is_null() && sensors_of(s) != 1)
    fmt::format_to(to, ", skew below {:.3f} ms", 1e3 * sampler.at("skew_bound_s").get<double>());
  write_stream_remarks(to, sampler, s.value("speed_up", 1.0));
  fmt::format_to(to, "\ncalibr.   {}\n", text_or(s, "cal", "none: the stream is raw and says so"));
  write_calibration(to, s);
  write_recording(to, "journal", s.at("journal"));
  write_recording(to, "samples", s.at("ring"));
  if (const auto console = s.find("console"); console != s.end() && console->is_string())
    fmt::format_to(to, "console   {} (mgt console prints it with the token for control)\n",
                   console->get<std::string>());
  write_clients(to, s);
  write_devices(to, s.at("devices"));
  write_inputs(to, s.value("inputs", nlohmann::json::array()));
  write_bytes(to, s.at("devices"));
  write_run(to, s.at("run"));
  if (const auto magnet = s.find("magnet"); magnet != s.end() && !magnet->is_null())
    fmt::format_to(to, "\nmagnet    a test is going on: {}\n          mgt run abort ends it\n",
                   text_or(*magnet, "text", ""));
}

int run_status(const Session& session, double patience_s) {
  const auto status = status_after(session, patience_s);
  if (!status) return print_error(session, status.error());
  const int code = patience_s > 0 && !all_live(*status) ? 1 : 0;
  if (session.json) {
    print_json(*status);
    return code;
  }
  std::string text;
  write_status(std::back_inserter(text), *status);
  print_text(session, text);
  return code;
}

}  // namespace

void add_status(CLI::App& app, Session& session) {
  auto patience_s = std::make_shared<double>(0);
  CLI::App* const command =
      add_command(app, session, "status", "devices, stream, calibration and run of the daemon",
                  [patience_s, &session] { return run_status(session, *patience_s); });
  command->add_option("--wait", *patience_s,
                      "up to so many seconds for every device to be live; exit code 1 when one is not");
}

}  // namespace mgtd::daemon::cli
