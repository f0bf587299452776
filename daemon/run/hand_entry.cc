// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/hand_entry.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <utility>

#include "daemon/plan/approach.h"
#include "daemon/plan/mount_plan.h"
#include "daemon/plan/mounting.h"
#include "proto/units.h"

namespace mgtd::daemon::run {
namespace {

using What = OperatorPrompt::What;
constexpr double kSameEntry_rad = to_rad(0.3);

bool same(const TableAngles& a, const TableAngles& b) {
  return std::abs(a.azimuth_rad - b.azimuth_rad) < kSameEntry_rad &&
         std::abs(a.pitch_rad - b.pitch_rad) < kSameEntry_rad &&
         std::abs(a.roll_rad - b.roll_rad) < kSameEntry_rad;
}

/// The scale on which an entry is so far from what was asked for that it may be misread; empty: none.
std::string far_from(const TableAngles& asked, const TableAngles& entered) {
  constexpr double kFar_rad = to_rad(10);
  const auto far = [](const char* scale, double wanted_rad, double read_rad) {
    if (std::abs(std::remainder(read_rad - wanted_rad, 2 * std::numbers::pi)) < kFar_rad)
      return std::string();
    return fmt::format("{} {:.6g} deg was entered where {:.6g} was asked for", scale, to_deg(read_rad),
                       to_deg(wanted_rad));
  };
  for (std::string text :
       {far("azimuth", asked.azimuth_rad, entered.azimuth_rad),
        far("pitch", asked.pitch_rad, entered.pitch_rad), far("roll", asked.roll_rad, entered.roll_rad)})
    if (!text.empty()) return text;
  return {};
}

std::string on_scales(const TableAngles& a) {
  return fmt::format("azimuth {:.6g}, pitch {:.6g}, roll {:.6g} deg", to_deg(a.azimuth_rad),
                     to_deg(a.pitch_rad), to_deg(a.roll_rad));
}

std::string request_text(What what, const plan::PlannedPose& pose, std::size_t poses) {
  if (what == What::note) return fmt::format("before pose {} of {}: {}", pose.number, poses, pose.note);
  if (what == What::mount)
    return fmt::format(
        "mounting {}: put the array on the table {} and enter its azimuth, pitch and roll on the "
        "table",
        pose.mount.value_or(0), plan::mounting_in_words(pose.mounting));
  return fmt::format("pose {} of {}: turn the table to {} and enter what its scales say", pose.number, poses,
                     on_scales(pose.target));
}

}  // namespace

HandEntry::HandEntry(bool scales, const plan::RunPlan& plan, const std::vector<Pose>& earlier)
    : scales_(scales),
      mounts_first_(!plan.poses.empty() && plan.poses.front().mount.has_value()),
      mounts_(std::any_of(plan.poses.begin(), plan.poses.end(),
                          [](const plan::PlannedPose& p) { return p.mount.has_value(); })),
      poses_(plan.poses.size()) {
  if (!used()) return;
  for (const Pose& pose : earlier) turns_.add(pose);
}

bool HandEntry::ask_before(const plan::PlannedPose& pose) {
  if (!pose.note.empty() && noted_ != pose.number) {
    ask(What::note, pose, {});
    return true;
  }
  if (pose.mount && mounted_ != pose.mount) {
    ask(What::mount, pose, {});
    return true;
  }
  if (scales_ && table_of_ != pose.number) {
    ask(What::table, pose, {});
    return true;
  }
  return false;
}

void HandEntry::ask(What what, const plan::PlannedPose& pose, std::string again) {
  prompt_ = OperatorPrompt{.what = what,
                           .pose = pose.number,
                           .mount = pose.mount,
                           .target = what == What::mount ? pose.mounting : pose.target,
                           .text = request_text(what, pose, poses_),
                           .again = std::move(again)};
}

std::string HandEntry::question() const {
  return prompt_->again.empty() ? prompt_->text : prompt_->again + "; " + prompt_->text;
}

void HandEntry::carried_out(const plan::PlannedPose& pose) {
  noted_ = pose.number;
  prompt_.reset();
}

Result<void> HandEntry::possible(const TableAngles& angles, const drivers::TableLimits& limits) const {
  if (prompt_->what == What::table && !plan::inside(limits, angles))
    return fail(ErrorCode::usage, fmt::format("{} is outside the table's limits", on_scales(angles)),
                "read the scales again; the limits are those of the configuration");
  return {};
}

std::string HandEntry::said(const TableAngles& angles) const {
  return fmt::format("pose {}: entered {}: {}", prompt_->pose,
                     prompt_->what == What::mount ? "the mounting of the array" : "the scales of the table",
                     on_scales(angles));
}

bool HandEntry::enter(const TableAngles& angles, const plan::PlannedPose& pose) {
  // The field cannot judge the first poses.
  const std::string far = far_from(prompt_->target, angles);
  const auto twice = [&](const std::optional<TableAngles>& before) {
    return before && same(*before, angles);
  };
  if (!far.empty() && !twice(far_) && !twice(disagreed_)) {
    far_ = angles;
    ask(prompt_->what, pose, far + ": look at the scales again");
    return false;
  }
  far_.reset();
  if (prompt_->what == What::mount) {
    mounted_ = pose.mount;
    mounting_ = angles;
  } else {
    table_of_ = pose.number;
    table_ = angles;
  }
  unproved_ = true;
  doubtful_ = false;
  prompt_.reset();
  return true;
}

TableAngles HandEntry::platform(const TableAngles& table) const {
  return mounted_ ? plan::platform_angles(mounting_, table) : table;
}

HandEntry::Judgement HandEntry::judge(const Pose& measured, const plan::PlannedPose& pose) {
  if (!unproved_) return {};
  const What what = scales_ ? What::table : What::mount;
  const TableAngles entry = what == What::mount ? mounting_ : table_;
  const RotationFinding finding = turns_.judge(measured);
  const std::string found =
      fmt::format("since pose {} the field turned by {:.1f} deg, what was entered means {:.1f} deg",
                  finding.against, to_deg(finding.measured_rad), to_deg(finding.entered_rad));
  const bool confirmed = disagreed_ && same(*disagreed_, entry);
  if (finding.agrees || confirmed) {
    doubtful_ = !finding.agrees;
    unproved_ = false;
    disagreed_.reset();
    return {true, doubtful_ ? found : ""};
  }
  disagreed_ = entry;
  if (what == What::mount) mounted_.reset();
  table_of_.reset();
  ask(what, pose, found + ": look at the scales again");
  return {false, found};
}

void HandEntry::stored(const Pose& pose) {
  if (used() && !doubtful_) turns_.add(pose);
}

void HandEntry::paused() { forgotten_ = std::exchange(table_of_, std::nullopt); }

HandEntry::Forgotten HandEntry::forget(const plan::PlannedPose& under_way) {
  Forgotten out;
  if (mounted_)
    out.mount = std::exchange(mounted_, std::nullopt);
  else
    out.last_pose = table_of_ != under_way.number && forgotten_ != under_way.number;
  forgotten_.reset();
  table_of_.reset();
  disagreed_.reset();
  far_.reset();
  return out;
}

}  // namespace mgtd::daemon::run
