// SPDX-License-Identifier: Apache-2.0
#include "daemon/serve/console/job_queue.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace mgtd::daemon::serve::console {

std::string_view name(JobState state) {
  switch (state) {
    case JobState::waiting:
      return "waiting";
    case JobState::running:
      return "running";
    case JobState::done:
      return "done";
    case JobState::failed:
      return "failed";
    case JobState::cancelled:
      return "cancelled";
  }
  return "";
}

Result<JobQueue::Id> JobQueue::put(JobTask task, Instant now) {
  std::size_t waiting = 0;
  for (auto& [id, job] : jobs_) {
    const bool alive = job.state != JobState::failed && job.state != JobState::cancelled;
    if (!task.changes && !job.task.changes && alive && job.task.question == task.question) {
      job.asked = now;
      return id;
    }
    waiting += job.state == JobState::waiting ? 1U : 0U;
  }
  if (waiting >= limits_.waiting)
    return fail(ErrorCode::refused, fmt::format("{} computations wait already", waiting),
                "wait for them, or cancel some");
  jobs_[++last_] = {.task = std::move(task), .asked = now};
  return last_;
}

std::optional<JobQueue::Id> JobQueue::next(Instant now) {
  std::size_t run = 0;
  bool writes = false;
  for (const auto& [id, job] : jobs_) {
    if (job.state != JobState::running) continue;
    ++run;
    writes = writes || job.task.changes;
  }
  for (auto& [id, job] : jobs_) {
    if (job.state != JobState::waiting) continue;
    const bool may = run == 0 || (run < limits_.at_once && !writes && !job.task.changes);
    if (!may) return std::nullopt;
    job.state = JobState::running;
    job.begun = now;
    return id;
  }
  return std::nullopt;
}

void JobQueue::end(Job& job, JobState state, Instant now) {
  if (job.state == JobState::running) job.ended = now;
  job.state = state;
}

void JobQueue::done(Id id, int exit_code, std::string result, Instant now) {
  const auto found = jobs_.find(id);
  if (found == jobs_.end() || found->second.state != JobState::running) return;
  found->second.exit_code = exit_code;
  found->second.result = std::move(result);
  end(found->second, JobState::done, now);
  make_room();
}

void JobQueue::failed(Id id, std::string why, Instant now) {
  const auto found = jobs_.find(id);
  if (found == jobs_.end() || found->second.state != JobState::running) return;
  found->second.why = std::move(why);
  end(found->second, JobState::failed, now);
  make_room();
}

bool JobQueue::cancel(Id id, Instant now) {
  const auto found = jobs_.find(id);
  if (found == jobs_.end() || over(found->second)) return false;
  const bool runs = found->second.state == JobState::running;
  end(found->second, JobState::cancelled, now);
  make_room();
  return runs;
}

std::vector<JobQueue::Id> JobQueue::forgotten(Instant now) const {
  std::vector<Id> out;
  for (const auto& [id, job] : jobs_)
    if (!over(job) && !job.task.changes && now - job.asked > limits_.forgotten) out.push_back(id);
  return out;
}

const Job* JobQueue::ask(Id id, Instant now) {
  const auto found = jobs_.find(id);
  if (found == jobs_.end()) return nullptr;
  found->second.asked = now;
  return &found->second;
}

std::size_t JobQueue::running() const {
  return static_cast<std::size_t>(std::count_if(
      jobs_.begin(), jobs_.end(), [](const auto& each) { return each.second.state == JobState::running; }));
}

std::size_t JobQueue::before(Id id) const {
  return static_cast<std::size_t>(std::count_if(
      jobs_.begin(), jobs_.end(), [&](const auto& each) { return each.first < id && !over(each.second); }));
}

/// The results asked for longest ago go first; the latest stays in any case.
void JobQueue::make_room() {
  for (;;) {
    std::size_t bytes = 0, ended = 0;
    auto oldest = jobs_.end();
    for (auto at = jobs_.begin(); at != jobs_.end(); ++at) {
      if (!over(at->second)) continue;
      ++ended;
      bytes += at->second.result.size();
      if (oldest == jobs_.end() || at->second.asked < oldest->second.asked) oldest = at;
    }
    if (ended <= 1 || (bytes <= limits_.kept_bytes && ended <= limits_.kept_jobs)) return;
    jobs_.erase(oldest);
  }
}

}  // namespace mgtd::daemon::serve::console
