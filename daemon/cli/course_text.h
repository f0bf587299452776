// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json.hpp>
#include <string>

/// The course of a run (proto/run_course.h) for people: a few lines for a terminal.
namespace mgtd::daemon::cli {

[[nodiscard]] std::string course_text(const nlohmann::json& course);

}  // namespace mgtd::daemon::cli
