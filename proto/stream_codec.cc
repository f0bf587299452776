// SPDX-License-Identifier: Apache-2.0
#include "proto/stream_codec.h"

#include <nlohmann/json.hpp>

#include "proto/json_line.h"
#include "proto/status_codec.h"

namespace mgtd {
namespace {

using OrderedJson = nlohmann::ordered_json;

std::string line_of_class(std::string_view stream_class, const OrderedJson& body) {
  OrderedJson object{{"class", stream_class}};
  object.update(body);
  return to_line(object);
}

}  // namespace

std::string encode(const Greeting& greeting) {
  return to_line({{"class", "HELLO"},
                  {"protocol", {{"major", kStreamProtocolMajor}, {"minor", kStreamProtocolMinor}}},
                  {"rig", greeting.rig},
                  {"software", greeting.software},
                  {"array", to_json(greeting.array)}});
}

std::string encode(const Gap& gap) {
  return to_line({{"class", "GAP"}, {"from_seq", gap.from_seq}, {"to_seq", gap.to_seq}, {"why", gap.why}});
}

std::string encode(const Error& error) {
  return to_line({{"class", "ERROR"}, {"message", error.message}, {"remedy", error.remedy}});
}

std::string encode(const StatusReport& report) { return line_of_class("STATUS", to_json(report)); }
std::string encode(const RunStatus& run) { return line_of_class("RUN", to_json(run)); }
std::string encode(const SensorsReport& sensors) { return line_of_class("SENSORS", to_json(sensors)); }

}  // namespace mgtd
