// SPDX-License-Identifier: Apache-2.0
#include "daemon/serve/stream_reader.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "proto/json_line.h"
#include "proto/stream_codec.h"

namespace mgtd::daemon::serve {
namespace {

using Json = nlohmann::json;

std::string text(const Json& object, const char* key) {
  const auto entry = object.find(key);
  return entry != object.end() && entry->is_string() ? entry->get<std::string>() : std::string();
}

std::optional<Error> error_of(const Json& object) {
  if (text(object, "class") != "ERROR") return std::nullopt;
  return Error{ErrorCode::refused, text(object, "message"), text(object, "remedy")};
}

std::optional<Error> objection_to(const Json& greeting, const std::string& where) {
  if (auto error = error_of(greeting)) return error;
  const auto protocol = greeting.find("protocol");
  if (text(greeting, "class") != "HELLO" || protocol == greeting.end() || !protocol->is_object()) {
    return Error{ErrorCode::protocol, fmt::format("what answers at {} is not mgtd", where),
                 "is this the stream's address (keys tcp and unix under [stream])?"};
  }
  const auto number = protocol->find("major");
  const int major = number != protocol->end() && number->is_number_integer() ? number->get<int>() : 0;
  if (major == kStreamProtocolMajor) return std::nullopt;
  return Error{ErrorCode::protocol,
               fmt::format("the daemon speaks protocol {}, this program {}", major, kStreamProtocolMajor),
               "use mgt and mgtd of the same version"};
}

}  // namespace

Result<StreamReader> StreamReader::open(const std::string& where, const WatchRequest& request,
                                        Duration wait) {
  auto stream =
      where.find('/') != std::string::npos ? LineStream::connect_unix(where) : LineStream::connect_tcp(where);
  if (!stream) return tl::unexpected(stream.error());
  StreamReader reader(std::move(*stream));
  const auto hello = reader.stream_.read_line(wait);
  if (!hello) return tl::unexpected(hello.error());
  if (!*hello)
    return fail(
        ErrorCode::unreachable,
        fmt::format("{} is open, but nothing came from it within {:g} s", where, to_seconds(wait)),
        "systemctl status mgtd says what it is doing; is this the stream's address (keys tcp and unix "
        "under [stream])?");
  reader.greeting_ = Json::parse(**hello, nullptr, false);
  if (auto objection = objection_to(reader.greeting_, where)) return tl::unexpected(std::move(*objection));
  if (auto sent = reader.stream_.send_line(encode(request)); !sent) return tl::unexpected(sent.error());
  return reader;
}

Result<std::optional<Json>> StreamReader::next(Duration wait) {
  const auto line = stream_.read_line(wait);
  if (!line) return tl::unexpected(line.error());
  if (!*line) return std::nullopt;
  Json object = Json::parse(**line, nullptr, false);
  if (!object.is_object()) {
    return fail(ErrorCode::protocol, fmt::format("'{}' is not an object of the stream", excerpt(**line)),
                "use mgt and mgtd of the same version");
  }
  if (auto error = error_of(object)) return tl::unexpected(std::move(*error));
  return object;
}

}  // namespace mgtd::daemon::serve
