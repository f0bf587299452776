// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json.hpp>
#include <string>

/// sample_line() writes a sample of the stream as a line of `mgt watch --lines`: time of day, size of the
/// field, the gradient with its largest standard deviation, calibration and flags. Numbers stand below those
/// of the line before.
namespace mgtd::daemon::cli {

/// `sample`: a TENSOR object. Where the array tells no gradient the line has the components of the field and,
/// of sensors on one line, the derivative along it. "--" stands for what the stream has no number of. The
/// line has no end.
[[nodiscard]] std::string sample_line(const nlohmann::json& sample);

}  // namespace mgtd::daemon::cli
