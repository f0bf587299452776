// SPDX-License-Identifier: Apache-2.0
#include "proto/watch_request.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "proto/json_line.h"

namespace mgtd {
namespace {

using Json = nlohmann::json;

constexpr std::string_view kWatchExample = R"({"watch":{"class":["TENSOR"],"rate_hz":10}})";

tl::unexpected<Error> refuse(std::string message) {
  return fail(ErrorCode::bad_input, std::move(message), fmt::format("send {}", kWatchExample));
}

Result<StreamClasses> parse_classes(const Json& list) {
  if (!list.is_array()) return refuse(fmt::format("class is {}, not a list of names", excerpt(list.dump())));
  StreamClasses classes;
  for (const Json& entry : list) {
    const auto* const known = entry.is_string()
                                  ? std::find(kStreamClassNames.begin(), kStreamClassNames.end(),
                                              std::string_view(entry.get_ref<const std::string&>()))
                                  : kStreamClassNames.end();
    if (known == kStreamClassNames.end()) {
      const std::string found = entry.dump(-1, ' ', true, Json::error_handler_t::replace);
      return fail(ErrorCode::bad_input, fmt::format("class {} does not exist", excerpt(found)),
                  fmt::format("choose from {}", fmt::join(kStreamClassNames, ", ")));
    }
    classes.add(static_cast<StreamClass>(known - kStreamClassNames.begin()));
  }
  return classes;
}

Result<double> parse_rate(const Json& value) {
  const double rate_hz = value.is_number() ? value.get<double>() : 0.0;
  if (!(rate_hz >= kWatchRateMin_hz && rate_hz <= kWatchRateMax_hz)) {
    return fail(ErrorCode::bad_input,
                fmt::format("rate_hz is {}, not a number from {} to {}",
                            excerpt(value.dump(-1, ' ', true, Json::error_handler_t::replace)),
                            kWatchRateMin_hz, kWatchRateMax_hz),
                "leave rate_hz out for every sample");
  }
  return rate_hz;
}

Result<WatchRequest> parse_fields(const Json& watch) {
  WatchRequest request;
  for (const auto& [key, value] : watch.items()) {
    if (key != "class" && key != "rate_hz" && key != "from_seq") {
      return fail(ErrorCode::bad_input, fmt::format("watch has no key '{}'", excerpt(key)),
                  "its keys are class, rate_hz and from_seq");
    }
    if (value.is_null()) continue;
    if (key == "class") {
      const auto classes = parse_classes(value);
      if (!classes) return tl::unexpected(classes.error());
      request.classes = *classes;
    } else if (key == "rate_hz") {
      const auto rate_hz = parse_rate(value);
      if (!rate_hz) return tl::unexpected(rate_hz.error());
      request.rate_hz = *rate_hz;
    } else if (value.is_number_unsigned()) {
      request.from_seq = value.get<std::uint64_t>();
    } else {
      return fail(ErrorCode::bad_input,
                  fmt::format("from_seq is {}, not a sequence number",
                              excerpt(value.dump(-1, ' ', true, Json::error_handler_t::replace))),
                  "send the seq of the last sample you have plus one, or null");
    }
  }
  return request;
}

}  // namespace

Result<WatchRequest> parse_watch(std::string_view line) {
  const auto object = parse_json_object(line, kWatchExample);
  if (!object) return tl::unexpected(object.error());
  const auto watch = object->find("watch");
  if (object->contains("cmd")) {
    return fail(ErrorCode::refused, "this stream is read-only and takes no commands",
                "commands go to the control socket of the daemon (mgt run, mgt calibrations)");
  }
  if (watch == object->end() || object->size() != 1) {
    return refuse(fmt::format("'{}' is no watch", excerpt(line)));
  }
  if (!watch->is_object()) return refuse(fmt::format("'{}': watch is not an object", excerpt(line)));
  return parse_fields(*watch);
}

std::string encode(const WatchRequest& request) {
  Json classes = Json::array();
  for (std::size_t i = 0; i < kStreamClassNames.size(); ++i) {
    const auto c = static_cast<StreamClass>(i);
    const bool implied = c == StreamClass::gap && request.classes.has(StreamClass::tensor);
    if (request.classes.has(c) && !implied) classes.push_back(kStreamClassNames[i]);
  }
  nlohmann::ordered_json watch{{"class", std::move(classes)}, {"rate_hz", nullptr}, {"from_seq", nullptr}};
  if (request.rate_hz) watch["rate_hz"] = *request.rate_hz;
  if (request.from_seq) watch["from_seq"] = *request.from_seq;
  return nlohmann::ordered_json{{"watch", std::move(watch)}}.dump();
}

}  // namespace mgtd
