// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <utility>

#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "daemon/serve/console/host_rule.h"
#include "proto/error.h"

/// These functions handle the requests and answers of the console as HTTP has them: what the rules read from
/// a head, and the headers that every answer carries.
namespace mgtd::daemon::serve::console {

using Request = boost::beast::http::request<boost::beast::http::string_body>;
using Response = boost::beast::http::response<boost::beast::http::string_body>;

/// Nothing where the request has no such header.
[[nodiscard]] std::optional<std::string_view> field(const Request& request, std::string_view name);
/// Without what stands behind a question mark.
[[nodiscard]] std::string_view path_of(const Request& request);
[[nodiscard]] bool asks_for_job(const Request& request);
[[nodiscard]] RequestHead head_of(const Request& request);

/// On every answer: the page may load and reach nothing but what this server hands out.
void forbid_all_else(Response& response, std::string_view host);

[[nodiscard]] std::string in_json(const Error& error);
[[nodiscard]] Response refusal(const Request& request, const Error& why,
                               boost::beast::http::status status = boost::beast::http::status::forbidden);

}  // namespace mgtd::daemon::serve::console
