// SPDX-License-Identifier: Apache-2.0
// What is set by hand: asked for, entered, held against the turn of the field, entered again.
#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "daemon/plan/approach.h"
#include "daemon/plan/mount_plan.h"
#include "daemon/plan/mounting.h"
#include "daemon/run/run_fsm.h"

namespace mgtd::daemon {
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

std::string request_text(What what, const PlannedPose& pose, std::size_t poses) {
  if (what == What::note) return fmt::format("before pose {} of {}: {}", pose.number, poses, pose.note);
  if (what == What::mount)
    return fmt::format(
        "mounting {}: put the array on the table {} and enter its azimuth, pitch and roll on the "
        "table",
        pose.mount.value_or(0), mounting_in_words(pose.mounting));
  return fmt::format("pose {} of {}: turn the table to {} and enter what its scales say", pose.number, poses,
                     on_scales(pose.target));
}

}  // namespace

bool RunFsm::by_hand() const {
  return config_.by_hand || (!plan_.poses.empty() && plan_.poses.front().mount.has_value());
}

TableAngles RunFsm::recorded(const TableAngles& table) const {
  return mounted_ ? platform_angles(mounting_, table) : table;
}

bool RunFsm::ask_hands() {
  if (!planned().note.empty() && noted_ != planned().number) {
    ask(What::note, {});
    return true;
  }
  if (planned().mount && mounted_ != planned().mount) {
    ask(What::mount, {});
    return true;
  }
  if (config_.by_hand && scales_of_ != planned().number) {
    ask(What::table, {});
    return true;
  }
  return false;
}

void RunFsm::ask(What what, std::string again) {
  act(StopTable{});
  prompt_ = OperatorPrompt{.what = what,
                           .pose = planned().number,
                           .mount = planned().mount,
                           .target = what == What::mount ? planned().mounting : planned().target,
                           .text = request_text(what, planned(), plan_.poses.size()),
                           .again = std::move(again)};
  enter(Phase::asking, prompt_->again.empty() ? prompt_->text : prompt_->again + "; " + prompt_->text);
  act(Record{message_});
}

Result<void> RunFsm::possible(const ScaleEntered& entered) const {
  if (asks_for_deed())
    return fail(ErrorCode::state, "no scales are asked for now: " + prompt_->text,
                "when it is done: mgt run resume");
  if (phase_ != Phase::asking)
    return fail(ErrorCode::state, "nothing is asked for now",
                "mgt run status shows what is; mgt run redo asks for the last entry again");
  if (prompt_->what == What::table && !inside(config_.limits, entered.angles))
    return fail(ErrorCode::usage, fmt::format("{} is outside the table's limits", on_scales(entered.angles)),
                "read the scales again; the limits are those of the configuration");
  return {};
}

void RunFsm::on(const ScaleEntered& entered) {
  if (!possible(entered)) return;
  act(Record{
      fmt::format("pose {}: entered {}: {}", prompt_->pose,
                  prompt_->what == What::mount ? "the mounting of the array" : "the scales of the table",
                  on_scales(entered.angles))});
  // The first poses cannot tell by the field. The same entry twice is the operator's word.
  const std::string far = far_from(prompt_->target, entered.angles);
  const auto twice = [&](const std::optional<TableAngles>& x) { return x && same(*x, entered.angles); };
  if (!far.empty() && !twice(far_) && !twice(doubted_)) {
    far_ = entered.angles;
    return ask(prompt_->what, far + ": look at the scales again");
  }
  far_.reset();
  if (prompt_->what == What::mount) {
    mounted_ = planned().mount;
    mounting_ = entered.angles;
  } else {
    scales_of_ = planned().number;
    scales_ = entered.angles;
  }
  unproved_ = true;
  doubtful_ = false;
  prompt_.reset();
  go_on();
}

/// What the note of the pose wants is done.
void RunFsm::carried_out() {
  noted_ = planned().number;
  prompt_.reset();
  go_on();
}

/// Judged at the first pose that was measured with an entry. The same entry twice is the operator's word.
bool RunFsm::believed(const Pose& pose) {
  if (!unproved_) return true;
  const What what = config_.by_hand ? What::table : What::mount;
  const TableAngles& entry = what == What::mount ? mounting_ : scales_;
  const RotationFinding verdict = field_turn_.judge(pose);
  const std::string found =
      fmt::format("since pose {} the field turned by {:.1f} deg, what was entered means {:.1f} deg",
                  verdict.against, to_deg(verdict.measured_rad), to_deg(verdict.entered_rad));
  const bool confirmed = doubted_ && same(*doubted_, entry);
  if (verdict.agrees || confirmed) {
    doubtful_ = !verdict.agrees;
    if (doubtful_) act(Record{"the operator stands by the entry: " + found});
    unproved_ = false;
    doubted_.reset();
    return true;
  }
  doubted_ = entry;
  if (what == What::mount) mounted_.reset();
  scales_of_.reset();
  ask(what, found + ": look at the scales again");
  return false;
}

void RunFsm::drop(const std::vector<std::size_t>& poses) {
  std::vector<int> numbers;
  for (const std::size_t i : poses) {
    numbers.push_back(plan_.poses[i].number);
    progress_.undo(i);
    field_turn_.remove(plan_.poses[i].number);
  }
  if (!numbers.empty()) act(DropPoses{std::move(numbers)});
}

void RunFsm::redo() {
  act(StopTable{});
  std::vector<std::size_t> again;
  if (mounted_) {
    for (std::size_t i = 0; i < plan_.poses.size(); ++i)
      if (plan_.poses[i].mount == mounted_ && progress_.is_done(i)) again.push_back(i);
    mounted_.reset();
  } else if (scales_of_ != planned().number && forgotten_ != planned().number && last_stored_) {
    again.push_back(*last_stored_);
  }
  forgotten_.reset();
  last_stored_.reset();
  scales_of_.reset();
  doubted_.reset();
  far_.reset();
  attempt_ = 0;
  drop(again);
  go_on();
}

}  // namespace mgtd::daemon
