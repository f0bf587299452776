// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/watch_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "daemon/cli/progress.h"
#include "proto/status_codec.h"
#include "proto/time.h"

namespace mgtd::daemon::cli {
namespace {

constexpr std::array<const char*, 6> kComponents{"xx", "yy", "zz", "xy", "xz", "yz"};
constexpr double kLate_s = 3;  // a status comes every second

std::string number_text(const nlohmann::json& value, int decimals = 2) {
  return value.is_number() ? fmt::format("{:.{}f}", value.get<double>(), decimals) : "--";
}

std::string gradient_row(const std::string& name, const nlohmann::json& by_component) {
  std::string row = fmt::format("{:<10}", name);
  for (const char* c : kComponents) row += fmt::format("{:>10}", number_text(by_component.at(c)));
  return row + "\n";
}

std::string gradient_table(const nlohmann::json& sample) {
  const auto& gradient = sample.at("g_nT_per_m");
  if (std::none_of(gradient.begin(), gradient.end(), [](const auto& v) { return v.is_number(); })) return {};
  std::string out = fmt::format("{:<10}", "nT/m");
  for (const char* c : kComponents) out += fmt::format("{:>10}", c);
  out += "\n" + gradient_row("gradient", gradient);
  const auto& sd = sample.at("g_sd_nT_per_m");
  const bool known = std::any_of(sd.begin(), sd.end(), [](const auto& v) { return v.is_number(); });
  return known ? out + gradient_row("std. dev.", sd) : out;
}

std::string flags_text(const nlohmann::json& flags) {
  std::string out;
  for (const auto& flag : flags) out += (out.empty() ? "" : ", ") + flag.get<std::string>();
  return out.empty() ? "none" : out;
}

/// States in one line; below it, of each device that is not live, why.
std::string devices_text(const nlohmann::json& devices) {
  std::string states, reasons;
  for (const auto& d : devices) {
    const std::string name = d.at("name"), state = d.at("state");
    states += fmt::format("{}{} {}", states.empty() ? "" : ", ", name, state);
    if (const auto& why = d.at("detail"); state != "live" && why.is_string() && why != "")
      reasons += fmt::format("{:<10}{}: {}\n", "", name, why.get<std::string>());
  }
  return fmt::format("{:<10}{}\n{}", "devices", states, reasons);
}

std::string criticism_text(const nlohmann::json& criticism) {
  const std::string state = criticism.at("state");
  if (state == "none") return {};
  std::string out = fmt::format("{:<10}{}\n", "judged", state);
  if (state == "ok" || state == "learning") return out;
  for (const char* key : {"measured", "limit", "remedy"})
    out += fmt::format("{:<10}{}{}\n", "", key == std::string_view("limit") ? "limit: " : "",
                       criticism.at(key).get<std::string>());
  return out;
}

std::string run_text(const nlohmann::json& object, int width) {
  constexpr int kIndent = 10;
  const auto run = run_status_from_json(object);
  if (!run || run->run_id.empty() || !is_active(run->state)) return {};
  return fmt::format("{:<10}{}\n{:<10}{}\n", "run", progress_line(*run, std::max(width - kIndent, 0)), "",
                     run->message);
}

/// "2026-11-24 10:00:00.123 UTC"
std::string time_text(const nlohmann::json& object) {
  constexpr std::size_t kDay = 10, kTime = 12;
  const std::string t = object.at("t");
  return t.substr(0, kDay) + " " + t.substr(std::min(t.size(), kDay + 1), kTime) + " UTC";
}

/// How much later the second is; zero where a time cannot be read.
double seconds_between(const nlohmann::json& earlier, const nlohmann::json& later) {
  const auto from = parse_utc(earlier.at("t").get<std::string>());
  const auto to = parse_utc(later.at("t").get<std::string>());
  return from && to ? to_seconds(Duration(to->ns - from->ns)) : 0;
}

/// " (limit 18.5)", once a STATUS has said so.
std::string closure_limit_text(const nlohmann::json& status) {
  const nlohmann::json limit =
      status.is_object()
          ? status.value(nlohmann::json::json_pointer("/array/closure_limit"), nlohmann::json())
          : nlohmann::json();
  return limit.is_number() ? fmt::format(" (limit {})", number_text(limit, 1)) : "";
}

}  // namespace

std::string along_line_text(const nlohmann::json& sample) {
  const auto along = sample.find("along_line_nT_per_m");
  if (along == sample.end()) return {};
  std::string out = fmt::format("x {}, y {}, z {} nT/m along the line", number_text((*along)[0]),
                                number_text((*along)[1]), number_text((*along)[2]));
  double sd = 0;  // zero without a calibration
  for (const auto& value : sample.at("along_line_sd_nT_per_m"))
    if (value.is_number()) sd = std::max(sd, value.get<double>());
  if (sd > 0) out += fmt::format(", each to +-{:.2f} or better", sd);
  return out;
}

void WatchPanel::take(const nlohmann::json& object) {
  const std::string kind = object.at("class");
  if (kind == "TENSOR") sample_ = object;
  if (kind == "STATUS") status_ = object;
  if (kind != "GAP") return;
  missed_ += object.at("to_seq").get<std::uint64_t>() - object.at("from_seq").get<std::uint64_t>() + 1;
  last_gap_ = object.at("why");
}

std::string WatchPanel::sample_text() const {
  if (sample_.is_null()) return fmt::format("{:<10}none yet\n", "sample");
  std::string out = fmt::format("{:<10}{}, number {}\n", "sample", time_text(sample_),
                                sample_.at("seq").get<std::uint64_t>());
  if (!status_.is_null())
    if (const double late_s = seconds_between(sample_, status_); late_s > kLate_s)
      out += fmt::format("{:<10}none has come since, for {}\n", "", duration_text(late_s));
  const auto& cal = sample_.at("cal");
  out += fmt::format("{:<10}{}\n", "calibr.",
                     cal.is_string() ? cal.get<std::string>() : "none: these are raw numbers");
  out += fmt::format("{:<10}F {} nT\n", "field", number_text(sample_.at("f_nT")));
  if (const auto& b = sample_.at("b_nT"); b.is_array() && b.size() == 3 && b[0].is_number())
    out += fmt::format("{:<10}x {}, y {}, z {} nT\n", "", number_text(b[0]), number_text(b[1]),
                       number_text(b[2]));
  // Along an axis of the platform the table has it.
  if (const std::string table = gradient_table(sample_), along = along_line_text(sample_); !table.empty())
    out += table;
  else if (!along.empty())
    out += fmt::format("{:<10}{}\n", "gradient", along);
  if (const auto closure = sample_.find("closure");
      closure != sample_.end() && closure->is_object() && closure->at("chi2").is_number())
    out += fmt::format("{:<10}chi-square {}{}\n", "closure", number_text(closure->at("chi2"), 1),
                       closure_limit_text(status_));
  return out + fmt::format("{:<10}{}\n", "flags", flags_text(sample_.at("flags")));
}

std::string WatchPanel::status_text(int width) const {
  if (status_.is_null()) return {};
  return criticism_text(status_.at("criticism")) + devices_text(status_.at("devices")) +
         run_text(status_.at("run"), width);
}

std::string WatchPanel::text(int width) const {
  std::string out = sample_text() + status_text(width);
  if (missed_ > 0) out += fmt::format("{:<10}{} epochs; the last: {}\n", "missed", missed_, last_gap_);
  return out;
}

std::string top_of(const std::string& text, std::size_t rows) {
  const auto lines = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  if (rows < 3 || lines < rows) return text;
  std::size_t end = 0;
  for (std::size_t line = 0; line + 2 < rows; ++line) end = text.find('\n', end) + 1;
  return text.substr(0, end) + fmt::format("... {} lines more\n", lines - (rows - 2));
}

std::string back_over(std::size_t lines) {
  return lines == 0 ? std::string("\x1b[J") : fmt::format("\r\x1b[{}A\x1b[J", lines);
}

}  // namespace mgtd::daemon::cli
