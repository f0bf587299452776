// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

/// The course of a run (proto/run_course.h) for people: a few lines for a terminal; and what the run wrote
/// down of itself (proto/run_log.h), one line an entry.
namespace mgtd::daemon::cli {

[[nodiscard]] std::string course_text(const nlohmann::json& course);
[[nodiscard]] std::string events_text(const nlohmann::json& log);

}  // namespace mgtd::daemon::cli
