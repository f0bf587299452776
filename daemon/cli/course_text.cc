// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/course_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

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
    out += fmt::format("a good one: {}\n{}", good, accuracy_text(accuracy));
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
