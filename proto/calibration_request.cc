// SPDX-License-Identifier: Apache-2.0
#include "proto/calibration_request.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "proto/json_line.h"

namespace mgtd {
namespace {

using Json = nlohmann::json;

Result<bool> flag(const Json& args, const char* key) {
  const auto entry = args.find(key);
  if (entry == args.end()) return false;
  if (!entry->is_boolean()) return fail(ErrorCode::usage, fmt::format("{} is neither true nor false", key));
  return entry->get<bool>();
}

/// A reason as it is kept: of a length that a line of a list can show.
Result<std::string> reason(const Json& args) {
  constexpr std::size_t kLongest = 500;
  const auto why = args.find("why");
  if (why == args.end()) return std::string();
  if (!why->is_string()) return fail(ErrorCode::usage, "why is not a text");
  if (const std::size_t length = why->get_ref<const std::string&>().size(); length > kLongest)
    return fail(ErrorCode::usage,
                fmt::format("the reason has {} bytes, at most {} are kept", length, kLongest),
                "say it in fewer words");
  return why->get<std::string>();
}

}  // namespace

Result<std::string> parse_calibration_id(const Json& args) {
  const auto id = args.find("id");
  if (id == args.end() || !id->is_string() || id->get_ref<const std::string&>().empty()) {
    return fail(ErrorCode::usage, "no calibration is named", "mgt calibrations list shows their ids");
  }
  return id->get<std::string>();
}

Result<AcceptRequest> parse_accept_request(const Json& args) {
  auto id = parse_calibration_id(args);
  if (!id) return tl::unexpected(id.error());
  const auto force = flag(args, "force");
  if (!force) return tl::unexpected(force.error());
  auto why = reason(args);
  if (!why) return tl::unexpected(why.error());
  return AcceptRequest{*std::move(id), *force, *std::move(why)};
}

Result<RejectRequest> parse_reject_request(const Json& args) {
  auto id = parse_calibration_id(args);
  if (!id) return tl::unexpected(id.error());
  auto why = reason(args);
  if (!why) return tl::unexpected(why.error());
  if (why->find_first_not_of(" \t\r\n") == std::string::npos)
    return fail(ErrorCode::usage, "no reason is given",
                "it is kept, for who looks for this calibration later");
  return RejectRequest{*std::move(id), *std::move(why)};
}

Result<ImportRequest> parse_import_request(const Json& args) {
  const auto calibration = args.find("calibration");
  if (calibration == args.end() || !calibration->is_object())
    return fail(ErrorCode::usage, "no calibration is given", "the content of a CAL.json belongs here");
  const auto accept = flag(args, "accept"), force = flag(args, "force");
  if (!accept) return tl::unexpected(accept.error());
  if (!force) return tl::unexpected(force.error());
  const auto origin = args.find("origin");
  const bool named = origin != args.end() && origin->is_string();
  return ImportRequest{*calibration, named ? excerpt(origin->get<std::string>()) : "imported", *accept,
                       *force};
}

}  // namespace mgtd
