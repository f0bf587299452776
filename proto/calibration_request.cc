// SPDX-License-Identifier: Apache-2.0
#include "proto/calibration_request.h"

#include <fmt/format.h>

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
  return AcceptRequest{*std::move(id), *force};
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
