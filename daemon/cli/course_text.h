// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

/// These functions write the course of a run (proto/run_course.h) as a few lines for a terminal, and what the
/// run wrote down of itself (proto/run_log.h) as one line for each entry.
namespace mgtd::daemon::cli {

[[nodiscard]] std::string course_text(const nlohmann::json& course);
[[nodiscard]] std::string events_text(const nlohmann::json& log);

}  // namespace mgtd::daemon::cli
