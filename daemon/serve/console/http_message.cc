// SPDX-License-Identifier: Apache-2.0
#include "daemon/serve/console/http_message.h"

#include <fmt/format.h>

#include <boost/beast/http/field.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <nlohmann/json.hpp>

namespace mgtd::daemon::serve::console {

namespace beast = boost::beast;
namespace http = beast::http;

std::optional<std::string_view> field(const Request& request, std::string_view name) {
  const auto found = request.find(beast::string_view(name.data(), name.size()));
  if (found == request.end()) return std::nullopt;
  return std::string_view(found->value().data(), found->value().size());
}

std::string_view path_of(const Request& request) {
  const std::string_view target(request.target().data(), request.target().size());
  return target.substr(0, target.find('?'));
}

bool asks_for_job(const Request& request) {
  const std::string_view path = path_of(request);
  return path == "/jobs" || path.starts_with("/jobs/");
}

RequestHead head_of(const Request& request) {
  return {.host = field(request, "Host").value_or(""),
          .origin = field(request, "Origin"),
          .fetch_site = field(request, "Sec-Fetch-Site"),
          .websocket = beast::websocket::is_upgrade(request)};
}

void forbid_all_else(Response& response, std::string_view host) {
  const std::string policy = fmt::format(
      "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self' "
      "ws://{}; "
      "base-uri 'none'; form-action 'none'; frame-ancestors 'none'; require-trusted-types-for 'script'; "
      "trusted-types 'none'",
      host);
  response.set("Content-Security-Policy", policy);
  response.set("X-Content-Type-Options", "nosniff");
  response.set("Referrer-Policy", "no-referrer");
  response.set("Cross-Origin-Resource-Policy", "same-origin");
  response.set("Cross-Origin-Opener-Policy", "same-origin");
  response.set(http::field::cache_control, "no-store");
}

std::string in_json(const Error& error) {
  return nlohmann::json{{"error", {{"message", error.message}, {"remedy", error.remedy}}}}.dump(
      -1, ' ', false, nlohmann::json::error_handler_t::replace);
}

Response refusal(const Request& request, const Error& why, http::status status) {
  Response response{status, request.version()};
  response.set(http::field::content_type, "application/json");
  response.body() = in_json(why);
  return response;
}

}  // namespace mgtd::daemon::serve::console
