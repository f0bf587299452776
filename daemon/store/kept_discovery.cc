// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/kept_discovery.h"

#include <nlohmann/json.hpp>

#include "proto/json_text.h"

namespace mgtd::daemon::store {

using nlohmann::json;

std::string to_text(const KeptDiscovery& kept) {
  return json{{"data_hash", kept.data_hash}, {"model", kept.model}, {"at", kept.at}, {"found", kept.found}}
      .dump(-1, ' ', false, json::error_handler_t::replace);
}

Result<KeptDiscovery> discovery_from_text(const std::string& text) {
  constexpr const char* kRemedy = "search again: mgt discover RUN --keep";
  const auto kept = parse_json_text(text, kRemedy);
  if (!kept)
    return fail(ErrorCode::bad_input, "what was discovered cannot be read: " + kept.error().message, kRemedy);
  static const json kExample{
      {"data_hash", ""}, {"model", json::array({""})}, {"at", ""}, {"found", json::object()}};
  if (const auto wrong = misfit(kExample, *kept))
    return fail(ErrorCode::bad_input, "what was discovered cannot be read: " + wrong->text(text), kRemedy);
  return KeptDiscovery{kept->at("data_hash"), kept->at("model"), kept->at("at"), kept->at("found")};
}

}  // namespace mgtd::daemon::store
