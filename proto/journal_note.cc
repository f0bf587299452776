// SPDX-License-Identifier: Apache-2.0
#include "proto/journal_note.h"

#include <array>
#include <nlohmann/json.hpp>

#include "proto/json_line.h"

namespace mgtd {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr std::array<const char*, 3> kOrders{"home", "move", "stop"};

OrderedJson to_json(const TableAngles& a) { return {a.azimuth_rad, a.pitch_rad, a.roll_rad}; }
TableAngles angles(const OrderedJson& j) { return {j.at(0), j.at(1), j.at(2)}; }

OrderedJson to_json(const LifeNote& n) {
  OrderedJson out{
      {"note", "life"}, {"software", n.software}, {"first_seq", n.first_seq}, {"config", n.config}};
  if (n.before)
    out["before"] = {{"from_seq", n.before->from_seq}, {"to_seq", n.before->to_seq}, {"why", n.before->why}};
  return out;
}
OrderedJson to_json(const CalibrationNote& n) {
  return {{"note", "calibration"},
          {"calibration", n.json.empty() ? OrderedJson(nullptr) : OrderedJson(n.json)}};
}
OrderedJson to_json(const CalibratingNote& n) { return {{"note", "calibrating"}, {"on", n.on}}; }
OrderedJson to_json(const ReopenedNote& n) { return {{"note", "reopened"}, {"slot", n.slot}}; }
OrderedJson to_json(const TableOrder& n) {
  return {{"note", "order"},
          {"what", kOrders.at(static_cast<std::size_t>(n.what))},
          {"target_rad", to_json(n.target)}};
}
OrderedJson to_json(const TableNote& n) {
  const TableReading& r = n.reading;
  return {{"note", "table"},
          {"mono_ns", r.arrival.mono.time_since_epoch().count()},
          {"wall_ns", r.arrival.wall.ns},
          {"angles_rad", to_json(r.angles)},
          {"referenced", r.referenced},
          {"moving", r.moving},
          {"on_target", r.on_target}};
}
OrderedJson to_json(const LostNote& n) { return {{"note", "lost"}, {"bytes", n.bytes}}; }

/// A number that is written as a whole one: of any other the library makes what the processor makes of it.
template <class T = std::uint64_t>
T whole(const OrderedJson& j) {
  return static_cast<T>(j.get_ref<const OrderedJson::number_integer_t&>());
}

LifeNote life(const OrderedJson& j) {
  LifeNote n{j.at("software"), j.at("config"), whole(j.at("first_seq")), {}};
  if (j.contains("before")) {
    const OrderedJson& b = j.at("before");
    n.before = Gap{whole(b.at("from_seq")), whole(b.at("to_seq")), {}, b.at("why")};
  }
  return n;
}

TableOrder order(const OrderedJson& j) {
  const std::string what = j.at("what");
  TableOrder out{TableOrder::What::stop, angles(j.at("target_rad"))};
  for (std::size_t i = 0; i < kOrders.size(); ++i) {
    if (what == kOrders.at(i)) out.what = static_cast<TableOrder::What>(i);
  }
  return out;
}

TableNote table(const OrderedJson& j) {
  TableNote n;
  n.reading.arrival = {Instant{Duration{whole<std::int64_t>(j.at("mono_ns"))}},
                       WallTime{whole<std::int64_t>(j.at("wall_ns"))}};
  n.reading.angles = angles(j.at("angles_rad"));
  n.reading.referenced = j.at("referenced");
  n.reading.moving = j.at("moving");
  n.reading.on_target = j.at("on_target");
  return n;
}

std::optional<JournalNote> note_of(const OrderedJson& j) {
  const std::string kind = j.at("note");
  if (kind == "life") return life(j);
  if (kind == "calibration") {
    const OrderedJson& text = j.at("calibration");
    return CalibrationNote{text.is_null() ? std::string() : text.get<std::string>()};
  }
  if (kind == "calibrating") return CalibratingNote{j.at("on").get<bool>()};
  if (kind == "reopened") return ReopenedNote{whole<int>(j.at("slot"))};
  if (kind == "order") return order(j);
  if (kind == "table") return table(j);
  if (kind == "lost") return LostNote{whole(j.at("bytes"))};
  return std::nullopt;
}

}  // namespace

std::string encode(const JournalNote& note) {
  return std::visit([](const auto& n) { return to_line(to_json(n)); }, note);
}

Result<JournalNote> parse_note(std::string_view text) {
  // The library's only way of saying that a key is missing is to throw.
  try {
    if (auto note = note_of(OrderedJson::parse(text))) return *std::move(note);
  } catch (const nlohmann::json::exception&) {
  }
  return fail(ErrorCode::bad_input, "a note of the journal is not understood",
              "use the version of mgt that wrote it, or a later one");
}

}  // namespace mgtd
