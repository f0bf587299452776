// SPDX-License-Identifier: Apache-2.0
#include "daemon/serve/console/host_rule.h"

#include <fmt/format.h>

#include <algorithm>

#include "proto/json_line.h"

namespace mgtd::daemon::serve::console {
namespace {

constexpr std::uint16_t kHttpPort = 80;

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return out;
}

/// As a browser writes it in front of a port.
std::string bracketed(const std::string& name) {
  return name.find(':') != std::string::npos && !name.starts_with('[') ? "[" + name + "]" : name;
}

tl::unexpected<Error> refused(std::string_view header, std::string_view found, std::string_view why) {
  return fail(ErrorCode::refused, fmt::format("{}: {} {}", header, excerpt(found), why),
              "open the address that mgt console prints; another name of this computer belongs into hosts of "
              "[console]");
}

}  // namespace

HostRule::HostRule(std::uint16_t port, const std::vector<std::string>& names) {
  std::vector<std::string> all{"127.0.0.1", "localhost", "::1"};
  all.insert(all.end(), names.begin(), names.end());
  for (const std::string& name : all) {
    const std::string host = lower(bracketed(name));
    hosts_.push_back(fmt::format("{}:{}", host, port));
    if (port == kHttpPort) hosts_.push_back(host);
  }
}

bool HostRule::known(std::string_view host) const {
  return std::find(hosts_.begin(), hosts_.end(), lower(host)) != hosts_.end();
}

Result<void> HostRule::admit(const RequestHead& head) const {
  constexpr std::string_view kScheme = "http://";
  if (!known(head.host)) return refused("Host", head.host, "is no name of the console");
  if (head.origin && !(head.origin->starts_with(kScheme) && known(head.origin->substr(kScheme.size()))))
    return refused("Origin", *head.origin, "is not the console's own page");
  if (head.fetch_site && *head.fetch_site != "same-origin" && *head.fetch_site != "none")
    return refused("Sec-Fetch-Site", *head.fetch_site, "says that another page asks");
  if (head.websocket && !head.origin)
    return fail(ErrorCode::refused, "Origin: a WebSocket without it is not answered",
                "a script reads the stream's own socket: docs/stream.md");
  return {};
}

}  // namespace mgtd::daemon::serve::console
