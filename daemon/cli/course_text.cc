// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/course_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

namespace mgtd::daemon::cli {
namespace {

using Json = nlohmann::json;

std::string text_of(const Json& value) {
  return value.is_string() ? value.get<std::string>() : std::string();
}

/// At most so many lines, from the first to the last.
constexpr std::size_t kMostLines = 10;

std::string accuracy_text(const Json& accuracy) {
  const Json &poses = accuracy.at("poses"), &worst = accuracy.at("worst_nT_per_m"),
             &residual = accuracy.at("residual_nT");
  std::string out;
  const std::size_t lines = std::min(poses.size(), kMostLines);
  for (std::size_t i = 0; i < lines; ++i) {
    const std::size_t k = lines < 2 ? 0 : i * (poses.size() - 1) / (lines - 1);
    out += fmt::format(
        "  {:>5} poses  {:.3g} nT/m{}\n", poses.at(k).get<int>(), worst.at(k).get<double>(),
        residual.at(k).is_null() ? "" : fmt::format(", residual {:.3g} nT", residual.at(k).get<double>()));
  }
  return out;
}

/// "s3 theta" is parameter theta of s3.
std::pair<std::string, std::string> sensor_and_parameter(const std::string& name) {
  const std::size_t space = name.find(' ');
  return {name.substr(0, space), space == std::string::npos ? "" : name.substr(space + 1)};
}

/// The standard error of every parameter after the last fit: a line for each parameter, a column for each
/// sensor. Empty where the last fit does not tell them.
std::string parameters_text(const Json& accuracy) {
  const Json &names = accuracy.at("parameters").at("name"), &units = accuracy.at("parameters").at("unit"),
             &sd = accuracy.at("parameters").at("sd");
  if (sd.empty() || sd.back().is_null()) return {};
  std::vector<std::string> sensors, lines;
  std::map<std::string, std::string> line_of;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto [sensor, parameter] = sensor_and_parameter(text_of(names.at(i)));
    if (sensors.empty() || sensors.back() != sensor) sensors.push_back(sensor);
    const bool ratio = text_of(units.at(i)).empty();
    const auto [line, is_new] = line_of.try_emplace(
        parameter, fmt::format("  {:<6} {:>4}", parameter, ratio ? "ppm" : text_of(units.at(i))));
    if (is_new) lines.push_back(parameter);
    const Json& value = sd.back().at(i);
    line->second += value.is_null() ? fmt::format(" {:>8}", "-")
                                    : fmt::format(" {:>8.3g}", (ratio ? 1e6 : 1) * value.get<double>());
  }
  std::string out = fmt::format("standard errors of the parameters after {} poses:\n  {:<6} {:>4}",
                                accuracy.at("poses").back().get<int>(), "", "unit");
  for (const std::string& sensor : sensors) out += fmt::format(" {:>8}", sensor);
  out += '\n';
  for (const std::string& parameter : lines) out += line_of.at(parameter) + '\n';
  return out;
}

std::string disturbance_text(const Json& d) {
  return fmt::format("  {}  pose {}: {:.2g} nT (limit {:.2g} nT), {}; {}\n", text_of(d.at("t")),
                     d.at("pose").get<int>(), d.at("change_nT").get<double>(), d.at("limit_nT").get<double>(),
                     d.at("lasted_s").is_null() ? std::string("not over when last seen")
                                                : fmt::format("{:.0f} s", d.at("lasted_s").get<double>()),
                     text_of(d.at("then")));
}

}  // namespace

std::string course_text(const Json& course) {
  if (text_of(course.at("run_id")).empty()) return "no run yet\n";
  const Json &coverage = course.at("coverage"), &accuracy = course.at("accuracy"),
             &disturbances = course.at("disturbances");
  const Json& states = coverage.at("state");
  std::string out = fmt::format("run {}\ncoverage: {} of {} poses measured", text_of(course.at("run_id")),
                                std::count(states.begin(), states.end(), "measured"), states.size());
  if (const std::string good = text_of(coverage.at("good")); !good.empty())
    out += fmt::format(". A good one: {}", good);
  out += "\naccuracy of the worst component: ";
  if (const std::string good = text_of(accuracy.at("good")); !good.empty())
    out += fmt::format("a good one: {}\n{}{}", good, accuracy_text(accuracy), parameters_text(accuracy));
  else
    out += fmt::format("not known yet{}\n",
                       accuracy.at("why").is_null() ? "" : ": " + text_of(accuracy.at("why")));
  out +=
      fmt::format("disturbances: {}\n", disturbances.empty() ? "none" : std::to_string(disturbances.size()));
  for (const Json& d : disturbances) out += disturbance_text(d);
  return out;
}

std::string events_text(const Json& log) {
  if (text_of(log.at("run_id")).empty()) return "no run yet\n";
  std::string out = fmt::format("run {}\n", text_of(log.at("run_id")));
  const auto left_out = log.at("left_out").get<std::size_t>();
  if (left_out > 0) out += fmt::format("{} earlier entries are in the run file only\n", left_out);
  for (const Json& event : log.at("events"))
    out += fmt::format("  {:.19}Z  {}\n", text_of(event.at("t")), text_of(event.at("what")));
  if (log.at("events").empty()) out += "  nothing out of the ordinary\n";
  return out;
}

}  // namespace mgtd::daemon::cli
