// SPDX-License-Identifier: Apache-2.0
#include "proto/run_request.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "proto/json_line.h"

namespace mgtd {
namespace {

using Json = nlohmann::json;

/// Reads each key once and remembers the first objection.
class Arguments {
 public:
  explicit Arguments(const Json& args) : args_(args) {}

  void number(const char* key, double low, double high, std::optional<double>& out) {
    const Json* const value = take(key);
    if (value == nullptr) return;
    if (value->is_number() && value->get<double>() >= low && value->get<double>() <= high) {
      out = value->get<double>();
    } else {
      object(key, *value, fmt::format("a number from {} to {}", low, high));
    }
  }
  void whole(const char* key, std::int64_t low, std::int64_t high, std::optional<int>& out) {
    const Json* const value = take(key);
    if (value == nullptr) return;
    if (value->is_number_integer() && value->get<double>() >= static_cast<double>(low) &&
        value->get<double>() <= static_cast<double>(high)) {
      out = value->get<int>();
    } else {
      object(key, *value, fmt::format("a whole number from {} to {}", low, high));
    }
  }
  void seed(const char* key, std::optional<std::uint64_t>& out) {
    const Json* const value = take(key);
    if (value == nullptr) return;
    if (value->is_number_unsigned()) {
      out = value->get<std::uint64_t>();
    } else {
      object(key, *value, "a whole number from 0 on");
    }
  }
  void poses(const char* key, std::vector<RequestedPose>& out) {
    const Json* const value = take(key);
    if (value == nullptr) return;
    if (!value->is_array() || value->empty()) return object(key, *value, "a list of poses");
    for (const Json& entry : *value) {
      auto pose = requested_pose_from_json(entry);
      if (pose) {
        out.push_back(*std::move(pose));
      } else if (!objection_) {
        objection_ = pose.error();
      }
    }
  }
  void text(const char* key, std::string& out) {
    const Json* const value = take(key);
    if (value == nullptr) return;
    if (value->is_string()) {
      out = excerpt(value->get<std::string>());
    } else {
      object(key, *value, "text");
    }
  }
  [[nodiscard]] std::optional<Error> objection() const {
    if (objection_) return objection_;
    for (const auto& [key, value] : args_.items()) {
      if (std::find(known_.begin(), known_.end(), key) == known_.end()) {
        return Error{ErrorCode::usage, fmt::format("a run has no argument '{}'", excerpt(key)),
                     fmt::format("its arguments are {}", fmt::join(known_, ", "))};
      }
    }
    return std::nullopt;
  }

 private:
  const Json* take(const char* key) {
    known_.emplace_back(key);
    const auto entry = args_.find(key);
    return entry == args_.end() || entry->is_null() ? nullptr : &*entry;
  }
  void object(const char* key, const Json& value, const std::string& expected) {
    if (objection_) return;
    const std::string found = value.dump(-1, ' ', true, Json::error_handler_t::replace);
    objection_ = Error{ErrorCode::usage, fmt::format("{} is {}, not {}", key, excerpt(found), expected),
                       "leave it out to use the configuration's value"};
  }

  const Json& args_;
  std::vector<std::string_view> known_;
  std::optional<Error> objection_;
};

}  // namespace

Result<RunRequest> parse_run_request(const Json& args) {
  RunRequest request;
  Arguments arguments(args);
  arguments.number("step_deg", 1, 120, request.step_deg);
  arguments.whole("random", 0, 100'000, request.random);
  arguments.whole("revisits", 0, 100'000, request.revisits);
  arguments.whole("retries", 0, 100, request.retries);
  arguments.number("dwell_short_s", 0.05, 3600, request.dwell_short_s);
  arguments.number("dwell_long_s", 0.05, 3600, request.dwell_long_s);
  arguments.seed("seed", request.seed);
  arguments.number("until_tensor_sd_nT_per_m", 1e-3, 1e6, request.until_tensor_sd_nT_per_m);
  arguments.number("until_explained_min", 1, 10'000, request.until_explained_min);
  arguments.text("list", request.list);
  arguments.poses("poses", request.poses);
  if (auto objection = arguments.objection()) return tl::unexpected(std::move(*objection));
  const bool sets = request.step_deg || request.random || request.revisits || request.seed;
  if (!request.poses.empty() && sets)
    return fail(ErrorCode::usage, "the poses are given, and so are step, random, revisits or seed",
                "leave one of both out");
  return request;
}

Json to_json(const RunRequest& request) {
  Json args = Json::object();
  const auto put = [&](const char* key, const auto& value) {
    if (value) args[key] = *value;
  };
  put("step_deg", request.step_deg);
  put("random", request.random);
  put("revisits", request.revisits);
  put("retries", request.retries);
  put("dwell_short_s", request.dwell_short_s);
  put("dwell_long_s", request.dwell_long_s);
  put("seed", request.seed);
  put("until_tensor_sd_nT_per_m", request.until_tensor_sd_nT_per_m);
  put("until_explained_min", request.until_explained_min);
  if (!request.list.empty()) args["list"] = request.list;
  for (const RequestedPose& pose : request.poses) args["poses"].push_back(to_json(pose));
  return args;
}

}  // namespace mgtd
