// SPDX-License-Identifier: Apache-2.0
#include "proto/control_codec.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "proto/json_line.h"
#include "proto/json_text.h"

namespace mgtd {
namespace {

using Json = nlohmann::json;

constexpr std::string_view kStatusExample = R"({"cmd":"status","id":1})";

bool can_be_id(const Json& id) { return id.is_null() || id.is_number() || id.is_string(); }

Result<ControlCommand> find_command(const Json& object) {
  const auto cmd = object.find("cmd");
  if (cmd == object.end() || !cmd->is_string()) {
    return fail(ErrorCode::bad_input, "the request has no \"cmd\"", fmt::format("send {}", kStatusExample));
  }
  const auto& text = cmd->get_ref<const std::string&>();
  const auto* const known = std::find(kControlCommandNames.begin(), kControlCommandNames.end(), text);
  if (known == kControlCommandNames.end()) {
    return fail(ErrorCode::usage, fmt::format("command '{}' does not exist", excerpt(text)),
                fmt::format("choose from {}", fmt::join(kControlCommandNames, ", ")));
  }
  return static_cast<ControlCommand>(known - kControlCommandNames.begin());
}

std::optional<std::string> unknown_key(const Json& object) {
  for (const auto& [key, value] : object.items()) {
    if (key != "cmd" && key != "args" && key != "id") return key;
  }
  return std::nullopt;
}

}  // namespace

std::string_view name(ControlCommand command) {
  return kControlCommandNames.at(static_cast<std::size_t>(command));
}

tl::expected<ControlRequest, ControlRefusal> parse_control(std::string_view text) {
  const auto refuse = [](Error error, Json id) {
    return tl::unexpected<ControlRefusal>(ControlRefusal{std::move(error), std::move(id)});
  };
  auto object = parse_json_object(text, kStatusExample);
  if (!object) return refuse(std::move(object.error()), nullptr);
  Json id = object->value("id", Json());
  if (!can_be_id(id)) {
    return refuse({ErrorCode::bad_input, "\"id\" is neither a number nor text", "leave it out"}, nullptr);
  }
  const auto command = find_command(*object);
  if (!command) return refuse(command.error(), std::move(id));
  if (const auto key = unknown_key(*object)) {
    return refuse({ErrorCode::bad_input, fmt::format("the request has an unknown key '{}'", excerpt(*key)),
                   "its keys are cmd, args and id"},
                  std::move(id));
  }
  Json args = object->value("args", Json::object());
  if (!args.is_object()) {
    return refuse({ErrorCode::bad_input, "\"args\" is not an object", "leave it out when there are none"},
                  std::move(id));
  }
  return ControlRequest{*command, std::move(args), std::move(id)};
}

std::string encode(const ControlRequest& request) {
  nlohmann::ordered_json object = nlohmann::ordered_json::object();
  object["cmd"] = name(request.command);
  if (!request.args.empty()) object["args"] = request.args;
  if (!request.id.is_null()) object["id"] = request.id;
  return to_line(object);
}

std::string encode_reply(const Json& id, const Result<nlohmann::ordered_json>& result) {
  nlohmann::ordered_json object = nlohmann::ordered_json::object();
  object["ok"] = result.has_value();
  object["id"] = id;
  if (result) {
    object["result"] = *result;
  } else {
    const Error& error = result.error();
    object["error"] = {{"code", name(error.code)}, {"message", error.message}, {"remedy", error.remedy}};
  }
  return to_line(object);
}

Result<ControlReply> parse_reply(std::string_view text) {
  const auto foreign = [&] {
    return fail(ErrorCode::protocol, fmt::format("'{}' is no answer of mgtd", excerpt(text)),
                "is another program listening on this socket? use mgt and mgtd of the same version");
  };
  if (nests_too_deeply(text)) return foreign();
  const Json object = Json::parse(text, nullptr, false);
  if (!object.is_object()) return foreign();
  const auto ok = object.find("ok");
  if (ok == object.end() || !ok->is_boolean()) return foreign();
  Json id = object.value("id", Json());
  if (ok->get<bool>()) {
    if (!object.contains("result")) return foreign();
    return ControlReply{std::move(id), object["result"]};
  }
  const auto error = object.find("error");
  if (error == object.end() || !error->is_object()) return foreign();
  const auto text_of = [&](const char* key) {
    const auto entry = error->find(key);
    return entry != error->end() && entry->is_string() ? entry->get<std::string>() : std::string();
  };
  return ControlReply{std::move(id),
                      fail(error_code_from_name(text_of("code")), text_of("message"), text_of("remedy"))};
}

}  // namespace mgtd
