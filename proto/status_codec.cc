// SPDX-License-Identifier: Apache-2.0
#include "proto/status_codec.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace mgtd {
namespace {

using OrderedJson = nlohmann::ordered_json;

OrderedJson number(double value) { return std::isfinite(value) ? OrderedJson(value) : OrderedJson(nullptr); }

template <class T>
OrderedJson optional(const std::optional<T>& value) {
  return value ? OrderedJson(*value) : OrderedJson(nullptr);
}

OrderedJson age_s(const std::optional<Instant>& since, Instant now) {
  return since ? OrderedJson(to_seconds(now - *since)) : OrderedJson(nullptr);
}

OrderedJson rejected(const LinkHealth& health) {
  OrderedJson counts = OrderedJson::object();
  for (std::size_t i = 0; i < kRejects; ++i) counts[std::string(kRejectNames[i])] = health.rejected[i];
  return counts;
}

OrderedJson to_json(const std::optional<ClockStatus>& clock) {
  if (!clock) return nullptr;
  return {{"rate_error", number(clock->rate_error)},
          {"rate_error_pm", number(clock->rate_error_pm)},
          {"bound_s", number(clock->bound_s)},
          {"delivery_s", number(clock->delivery_s)},
          {"settled", clock->settled},
          {"trouble", clock->trouble}};
}

OrderedJson to_json(const DeviceStatus& device, Instant now) {
  const LinkHealth& h = device.health;
  return {{"name", device.name},
          {"driver", device.driver},
          {"port", device.port},
          {"state", kLinkStateNames.at(static_cast<std::size_t>(h.state))},
          {"detail", h.detail},
          {"identity", h.identity},
          {"bytes_in", h.bytes_in},
          {"bytes_in_frames", h.bytes_in_frames},
          {"bytes_rejected", h.bytes_rejected},
          {"bytes_resync", h.bytes_resync},
          {"bytes_pending", h.bytes_pending},
          {"bytes_out", h.bytes_out},
          {"frames", h.frames},
          {"rejected", rejected(h)},
          {"opens", h.opens},
          {"closes", h.closes},
          {"balanced", h.balanced()},
          {"last_frame_age_s", age_s(h.last_frame, now)},
          {"state_since_s", age_s(h.state_since, now)},
          {"rate_hz", optional(device.rate_hz)},
          {"clock", to_json(device.clock)}};
}

/// null where there are none.
OrderedJson temperatures(const std::vector<std::optional<double>>& T_degC) {
  if (T_degC.empty()) return nullptr;
  OrderedJson out = OrderedJson::array();
  for (const auto& T : T_degC) out.push_back(T ? number(*T) : OrderedJson(nullptr));
  return out;
}

OrderedJson to_json(const CalibrationUse& use) {
  OrderedJson left_out = OrderedJson::array();
  for (const auto& [effect, lacks] : use.left_out) left_out.push_back({{"effect", effect}, {"lacks", lacks}});
  return {{"forced", use.forced},
          {"left_out", std::move(left_out)},
          {"age_s", optional(use.age_s)},
          {"made_at_degC", temperatures(use.made_at_degC)},
          {"now_degC", temperatures(use.now_degC)}};
}

OrderedJson to_json(const InputStatus& input, Instant now) {
  return {{"name", input.name},
          {"device", input.device},
          {"input", input.input},
          {"unit", input.unit.empty() ? OrderedJson(nullptr) : OrderedJson(input.unit)},
          {"value", input.value ? number(*input.value) : OrderedJson(nullptr)},
          {"age_s", age_s(input.heard, now)}};
}

OrderedJson clients(const ClientCounts& counts) {
  OrderedJson drops = OrderedJson::object();
  for (std::size_t i = 0; i < counts.drops.size(); ++i) drops[std::string(kDropNames[i])] = counts.drops[i];
  return {{"clients", counts.clients},   {"accepted", counts.accepted},     {"refused", counts.refused},
          {"dropped", counts.dropped()}, {"dropped_for", std::move(drops)}, {"last_drop", counts.last_drop}};
}

OrderedJson stream_json(const StreamStatus& stream) {
  OrderedJson out = clients(stream);
  out["gaps"] = stream.gaps;
  return out;
}

OrderedJson control_json(const ControlStatus& control) {
  OrderedJson out = clients(control);
  out["holder"] = to_json(control.holder);
  return out;
}

OrderedJson to_json(const RecordingStatus& recording) {
  return {{"state", recording.state},
          {"why", recording.why},
          {"bytes", recording.bytes},
          {"bytes_lost", recording.bytes_lost},
          {"stops", recording.stops}};
}

OrderedJson to_json(const Check& check) {
  return {{"name", check.name},
          {"passed", check.passed},
          {"measured", check.measured},
          {"limit", check.limit},
          {"remedy", check.remedy}};
}

/// Reads typed keys one after the other and remembers the first that is missing or of another type.
class Reader {
 public:
  explicit Reader(const nlohmann::json& object) : object_(object) {}

  void read(const char* key, std::string& out) { take(key, "text", &nlohmann::json::is_string, out); }
  void read(const char* key, bool& out) { take(key, "true or false", &nlohmann::json::is_boolean, out); }
  void read(const char* key, int& out) {
    take(key, "a whole number", &nlohmann::json::is_number_integer, out);
  }
  /// Absent and null are the same: not known.
  void read(const char* key, std::optional<double>& out) {
    if (!object_.contains(key) || object_[key].is_null()) return;
    read(key, out.emplace());
  }
  void read(const char* key, double& out) { take(key, "a number", &nlohmann::json::is_number, out); }
  [[nodiscard]] const std::string& objection() const { return objection_; }

 private:
  template <class T>
  void take(const char* key, const char* expected, bool (nlohmann::json::*is)() const noexcept, T& out) {
    const auto entry = object_.find(key);
    if (entry == object_.end()) {
      if (objection_.empty()) objection_ = fmt::format("'{}' is missing", key);
    } else if (!((*entry).*is)()) {
      if (objection_.empty()) objection_ = fmt::format("'{}' is not {}", key, expected);
    } else {
      out = entry->get<T>();
    }
  }

  const nlohmann::json& object_;
  std::string objection_;
};

tl::unexpected<Error> not_a_status(std::string_view why) {
  return fail(ErrorCode::protocol, fmt::format("the answer is no run status: {}", why),
              "use mgt and mgtd of the same version");
}

Result<Check> check_from_json(const nlohmann::json& entry) {
  Check check;
  Reader fields(entry);
  fields.read("name", check.name);
  fields.read("passed", check.passed);
  fields.read("measured", check.measured);
  fields.read("limit", check.limit);
  fields.read("remedy", check.remedy);
  if (!fields.objection().empty()) return not_a_status("in checks: " + fields.objection());
  return check;
}

Result<RunState> state_from_name(std::string_view text) {
  for (std::uint8_t i = 0; i <= static_cast<std::uint8_t>(RunState::interrupted); ++i) {
    if (name(static_cast<RunState>(i)) == text) return static_cast<RunState>(i);
  }
  return not_a_status(fmt::format("state '{}' is unknown", text));
}

}  // namespace

OrderedJson to_json(const RunStatus& run) {
  OrderedJson checks = OrderedJson::array();
  for (const Check& check : run.checks) checks.push_back(to_json(check));
  return {{"run_id", run.run_id},
          {"state", name(run.state)},
          {"set", run.set},
          {"pose", run.pose},
          {"poses", run.poses},
          {"retries", run.retries},
          {"elapsed_s", number(run.elapsed_s)},
          {"remaining_s", number(run.remaining_s)},
          {"message", run.message},
          {"goes_on", run.goes_on},
          {"prompt", run.prompt ? to_json(*run.prompt) : OrderedJson(nullptr)},
          {"field_change", run.field_change ? OrderedJson{{"change_nT", number(run.field_change->change_nT)},
                                                          {"limit_nT", number(run.field_change->limit_nT)}}
                                            : OrderedJson(nullptr)},
          {"tensor_sd_nT_per_m", optional(run.tensor_sd_nT_per_m)},
          {"wanted_tensor_sd_nT_per_m", optional(run.wanted_tensor_sd_nT_per_m)},
          {"judged", run.judged.empty() ? OrderedJson(nullptr) : OrderedJson(run.judged)},
          {"proposed", run.proposed.empty() ? OrderedJson(nullptr) : OrderedJson(run.proposed)},
          {"checks", std::move(checks)}};
}

OrderedJson to_json(const StatusReport& report) {
  OrderedJson devices = OrderedJson::array();
  for (const DeviceStatus& device : report.devices) devices.push_back(to_json(device, report.at.mono));
  OrderedJson inputs = OrderedJson::array();
  for (const InputStatus& input : report.inputs) inputs.push_back(to_json(input, report.at.mono));
  return {{"t", format_utc(report.at.wall)},
          {"t_ns", report.at.wall.ns},
          {"uptime_s", report.uptime_s},
          {"software", report.software},
          {"rig", report.rig},
          {"array", to_json(report.array)},
          {"speed_up", report.speed_up},
          {"cal", optional(report.calibration)},
          {"calibration", to_json(report.calibration_use)},
          {"criticism",
           {{"state", report.criticism.state},
            {"measured", report.criticism.measured},
            {"limit", report.criticism.limit},
            {"remedy", report.criticism.remedy}}},
          {"devices", std::move(devices)},
          {"inputs", std::move(inputs)},
          {"sampler",
           {{"epochs", report.sampler.epochs},
            {"gaps", report.sampler.gaps},
            {"rate_hz", optional(report.sampler.rate_hz)},
            {"skew_bound_s", optional(report.sampler.skew_bound_s)}}},
          {"stream", stream_json(report.stream)},
          {"control", control_json(report.control)},
          {"journal", to_json(report.journal)},
          {"ring", to_json(report.ring)},
          {"console", optional(report.console)},
          {"oldest_seq", optional(report.oldest_seq)},
          {"disk_free_bytes", optional(report.disk_free_bytes)},
          {"run", to_json(report.run)},
          {"magnet", report.magnet ? to_json(*report.magnet) : OrderedJson(nullptr)}};
}

Result<RunStatus> run_status_from_json(const nlohmann::json& object) {
  if (!object.is_object()) return not_a_status("it is no object");
  RunStatus run;
  std::string state;
  Reader reader(object);
  reader.read("run_id", run.run_id);
  reader.read("state", state);
  reader.read("set", run.set);
  reader.read("pose", run.pose);
  reader.read("poses", run.poses);
  reader.read("retries", run.retries);
  reader.read("elapsed_s", run.elapsed_s);
  if (object.contains("remaining_s") && !object["remaining_s"].is_null()) {
    reader.read("remaining_s", run.remaining_s);
  }
  reader.read("tensor_sd_nT_per_m", run.tensor_sd_nT_per_m);
  reader.read("wanted_tensor_sd_nT_per_m", run.wanted_tensor_sd_nT_per_m);
  reader.read("message", run.message);
  if (object.contains("goes_on")) reader.read("goes_on", run.goes_on);
  if (object.contains("judged") && !object["judged"].is_null()) reader.read("judged", run.judged);
  if (object.contains("proposed") && !object["proposed"].is_null()) reader.read("proposed", run.proposed);
  if (object.contains("prompt") && !object["prompt"].is_null()) {
    auto prompt = prompt_from_json(object["prompt"]);
    if (!prompt) return tl::unexpected(prompt.error());
    run.prompt = *std::move(prompt);
  }
  if (const auto seen = object.find("field_change"); seen != object.end() && seen->is_object()) {
    Reader inner(*seen);
    run.field_change.emplace();
    inner.read("change_nT", run.field_change->change_nT);
    inner.read("limit_nT", run.field_change->limit_nT);
    if (!inner.objection().empty()) return not_a_status("field_change: " + inner.objection());
  }
  if (!reader.objection().empty()) return not_a_status(reader.objection());
  const auto parsed = state_from_name(state);
  if (!parsed) return tl::unexpected(parsed.error());
  run.state = *parsed;
  for (const nlohmann::json& entry : object.value("checks", nlohmann::json::array())) {
    auto check = check_from_json(entry);
    if (!check) return tl::unexpected(check.error());
    run.checks.push_back(*std::move(check));
  }
  return run;
}

}  // namespace mgtd
