// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/calibration_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <utility>

#include "calib/validity/calibration_validity.h"
#include "daemon/store/durable_file.h"

namespace mgtd::daemon::store {
namespace {

using nlohmann::json;

constexpr const char* kLog = "calibrations.log";

Error unknown(std::string_view id) {
  return {ErrorCode::refused, fmt::format("there is no calibration {}", id),
          "list them: mgt calibrations list"};
}

Error failed_checks(const calib::calibration::Calibration& calibration) {
  std::string failed;
  for (const Check& c : calibration.checks) {
    if (!c.passed)
      failed += fmt::format("{}{} {} (limit {})", failed.empty() ? "" : ", ", c.name, c.measured, c.limit);
  }
  return {ErrorCode::refused, fmt::format("calibration {} failed its checks: {}", calibration.id, failed),
          "measure again; --force uses it all the same, and every sample says so"};
}

}  // namespace

std::string_view name(CalibrationState state) {
  static constexpr std::array<std::string_view, 4> kNames{"proposed", "accepted", "active", "rejected"};
  return kNames.at(static_cast<std::size_t>(state));
}

Result<CalibrationStore> CalibrationStore::open(std::filesystem::path directory) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (!std::filesystem::is_directory(directory)) {
    return fail(ErrorCode::io, fmt::format("cannot create {}: {}", directory.string(), error.message()),
                "check the owner of the directory above it");
  }
  CalibrationStore store(std::move(directory));
  if (auto ok = store.read_log(); !ok) return tl::unexpected(ok.error());
  return store;
}

/// A last line without its end was torn while it was written: that step did not happen.
Result<void> CalibrationStore::read_log() {
  const auto path = directory_ / kLog;
  if (!std::filesystem::exists(path)) return {};
  auto text = read_file(path);
  if (!text) return tl::unexpected(text.error());
  const std::size_t whole = text->rfind('\n') + 1;  // npos + 1 is 0
  if (whole < text->size()) {
    text->resize(whole);
    if (auto ok = write_durably(path, *text); !ok) return ok;
  }
  int number = 0;
  for (std::size_t at = 0; at < text->size();) {
    const std::size_t end = text->find('\n', at);
    ++number;
    const json line = json::parse(text->begin() + static_cast<std::ptrdiff_t>(at),
                                  text->begin() + static_cast<std::ptrdiff_t>(end), nullptr, false);
    at = end + 1;
    const auto word = [&](const char* key) {
      return line.is_object() && line.contains(key) && line[key].is_string() ? line[key].get<std::string>()
                                                                             : "";
    };
    const auto t = parse_utc(word("t"));
    const bool known = word("event") == "proposed" || word("event") == "accepted" ||
                       word("event") == "rejected" || word("event") == "rolled-back";
    if (!t || !known || word("id").empty()) {
      return fail(ErrorCode::bad_input,
                  fmt::format("{}:{}: not a line of the calibration log", path.string(), number),
                  "restore the file from a backup, or move it away: the calibrations beside it stay");
    }
    apply({*t, word("event"), word("id"), word("origin"), line.value("forced", json()) == true, word("why"),
           word("by")});
  }
  return {};
}

void CalibrationStore::apply(const CalibrationDecision& decision) {
  decisions_.push_back(decision);
  if (decision.what == "proposed") {
    entries_.push_back(
        {decision.id, CalibrationState::proposed, decision.at, decision.origin, false, "", decision.by});
    return;
  }
  if (decision.what == "rejected") {
    if (CalibrationEntry* entry = find(decision.id)) {
      entry->state = CalibrationState::rejected;
      entry->since = decision.at;
      entry->why = decision.why;
      entry->by = decision.by;
    }
    return;
  }
  if (const auto before = active_id()) {
    CalibrationEntry* entry = find(*before);
    if (entry != nullptr) {
      entry->state = CalibrationState::accepted;
      entry->since = decision.at;
    }
  }
  if (decision.what == "rolled-back") {
    if (!activations_.empty()) activations_.pop_back();
  } else {
    activations_.push_back(decision.id);
  }
  if (CalibrationEntry* entry = find(decision.id)) {
    entry->state = CalibrationState::active;
    entry->since = decision.at;
    entry->forced = entry->forced || decision.forced;
    entry->by = decision.by;
    if (decision.what == "accepted") entry->why = decision.why;
  }
}

Result<void> CalibrationStore::record(const CalibrationDecision& decision) {
  json line{{"t", format_utc(decision.at)},
            {"event", decision.what},
            {"id", decision.id},
            {"origin", decision.origin}};
  if (decision.forced) line["forced"] = true;
  if (!decision.why.empty()) line["why"] = decision.why;
  if (!decision.by.empty()) line["by"] = decision.by;
  const auto path = directory_ / kLog;
  std::error_code ignored;
  const auto size = std::filesystem::exists(path, ignored) ? std::filesystem::file_size(path, ignored) : 0;
  if (auto ok = append_durably(path, line.dump(-1, ' ', false, json::error_handler_t::replace) + "\n"); !ok) {
    std::filesystem::resize_file(path, size, ignored);  // no torn line before the next
    return ok;
  }
  apply(decision);
  return {};
}

CalibrationEntry* CalibrationStore::find(std::string_view id) {
  const auto found =
      std::find_if(entries_.begin(), entries_.end(), [&](const auto& e) { return e.id == id; });
  return found == entries_.end() ? nullptr : &*found;
}

std::filesystem::path CalibrationStore::file_of(std::string_view id) const {
  return directory_ / (std::string(id) + ".json");
}

Result<void> CalibrationStore::propose(const calib::calibration::Calibration& calibration,
                                       std::string_view origin, WallTime now, std::string_view by) {
  const std::string text = calib::calibration::to_json_text(calibration);
  if (const auto sound = calib::calibration::calibration_from_json_text(text);
      !sound || sound->id != calibration.id) {
    return fail(ErrorCode::internal, "a calibration that is not sealed cannot be proposed", "");
  }
  if (find(calibration.id) != nullptr) return {};
  if (auto ok = write_durably(file_of(calibration.id), text); !ok) return ok;
  return record({now, "proposed", calibration.id, std::string(origin), false, "", std::string(by)});
}

Result<void> CalibrationStore::import(const calib::calibration::Calibration& calibration,
                                      std::string_view origin, bool force, WallTime now,
                                      std::string_view by) {
  if (auto usable = calib::validity::validate(calibration); !usable) return usable;
  if (!calibration.accepted_by_checks && !force) return tl::unexpected(failed_checks(calibration));
  return propose(calibration, origin, now, by);
}

Result<void> CalibrationStore::accept(std::string_view id, WallTime now, bool force, std::string_view why,
                                      std::string_view by) {
  const CalibrationEntry* const entry = find(id);
  if (entry == nullptr) return tl::unexpected(unknown(id));
  if (active_id() == id) return {};
  if (entry->state == CalibrationState::rejected && !force) {
    return fail(
        ErrorCode::refused,
        fmt::format("calibration {} was rejected at {}: {}", id, format_utc(entry->since), entry->why),
        "measure again; --force uses it all the same");
  }
  const auto calibration = show(id);
  if (!calibration) return tl::unexpected(calibration.error());
  if (!calibration->accepted_by_checks && !force) return tl::unexpected(failed_checks(*calibration));
  return record({now, "accepted", std::string(id), "", !calibration->accepted_by_checks, std::string(why),
                 std::string(by)});
}

Result<void> CalibrationStore::reject(std::string_view id, std::string_view why, WallTime now,
                                      std::string_view by) {
  const CalibrationEntry* const entry = find(id);
  if (entry == nullptr) return tl::unexpected(unknown(id));
  if (entry->state == CalibrationState::rejected) return {};
  if (entry->state != CalibrationState::proposed) {
    return fail(ErrorCode::state,
                fmt::format("calibration {} is {}: only a proposal is rejected", id, name(entry->state)),
                "mgt calibrations rollback, or accept another");
  }
  return record({now, "rejected", std::string(id), "", false, std::string(why), std::string(by)});
}

Result<std::string> CalibrationStore::rollback(WallTime now, std::string_view by) {
  if (activations_.size() < 2) {
    return fail(ErrorCode::state, "no calibration was active before this one",
                "accept another: mgt calibrations list");
  }
  const std::string before = activations_[activations_.size() - 2];
  if (const auto readable = show(before); !readable) return tl::unexpected(readable.error());
  if (auto ok = record({now, "rolled-back", before, "", false, "", std::string(by)}); !ok)
    return tl::unexpected(ok.error());
  return before;
}

std::optional<std::string> CalibrationStore::active_id() const {
  if (activations_.empty()) return std::nullopt;
  return activations_.back();
}

Result<std::optional<calib::calibration::Calibration>> CalibrationStore::active() const {
  const auto id = active_id();
  if (!id) return std::nullopt;
  auto calibration = show(*id);
  if (!calibration) return tl::unexpected(calibration.error());
  return std::move(*calibration);
}

Result<calib::calibration::Calibration> CalibrationStore::show(std::string_view id) const {
  const bool known = std::any_of(entries_.begin(), entries_.end(), [&](const auto& e) { return e.id == id; });
  if (!known) return tl::unexpected(unknown(id));
  const auto text = read_file(file_of(id));
  if (!text) return tl::unexpected(text.error());
  auto calibration = calib::calibration::calibration_from_json_text(*text);
  if (calibration && calibration->id == id) return calibration;
  const std::string why =
      calibration ? "it holds calibration " + calibration->id : calibration.error().text();
  return fail(ErrorCode::bad_input, fmt::format("{} is damaged: {}", file_of(id).string(), why),
              "restore it from a backup, or roll back: mgt calibrations rollback");
}

}  // namespace mgtd::daemon::store
