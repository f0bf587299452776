// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proto/error.h"
#include "proto/time.h"

/// The job queue decides which computations run: one at a time where the other processor is for the
/// acquisition, a few where there is none, but what writes to a run file runs alone. A few wait in their
/// order, more are refused. What was computed is kept, in bounded memory, and given again while neither the
/// question nor the file has changed. A job that only reads and that nobody has asked about for a while has
/// lost its page, and ends. Pure: time comes in.
namespace mgtd::daemon::serve::console {

enum class JobState { waiting, running, done, failed, cancelled };
[[nodiscard]] std::string_view name(JobState state);

struct JobLimits {
  std::size_t at_once{1};  ///< of those that only read
  std::size_t waiting{8};
  std::size_t kept_bytes{64'000'000};             ///< of results
  std::size_t kept_jobs{64};                      ///< that have ended
  Duration forgotten{std::chrono::seconds(120)};  ///< a page in the background asks once a minute
};

struct JobTask {
  std::string question;  ///< verb, arguments and state of the file; the same question has the same answer
  std::string command;   ///< as a person types it
  std::vector<std::string> words;        ///< as it is run
  std::string type{"application/json"};  ///< of what it prints
  bool changes{false};  ///< writes: never answered from what is kept, never ended for want of a page
};

struct Job {
  JobTask task;
  JobState state{JobState::waiting};
  Instant asked{};                 ///< last time that a page asked about it
  Instant begun{};                 ///< of running
  std::optional<Instant> ended{};  ///< of running
  int exit_code{0};
  std::string result{};  ///< what the command printed
  std::string why{};     ///< it failed
};

class JobQueue {
 public:
  using Id = std::uint64_t;
  explicit JobQueue(JobLimits limits = {}) : limits_(limits) {}

  /// A new job, or one with the same question that only reads and has not failed. Refused while too many
  /// wait.
  [[nodiscard]] Result<Id> put(JobTask task, Instant now);
  /// The next one to run, which runs from now on; nothing while it has to wait, or none does.
  [[nodiscard]] std::optional<Id> next(Instant now);
  void done(Id id, int exit_code, std::string result, Instant now);
  void failed(Id id, std::string why, Instant now);
  /// True where the job runs, and is to be ended by the owner.
  [[nodiscard]] bool cancel(Id id, Instant now);
  /// Jobs that lost their page; those that run are to be ended by the owner.
  [[nodiscard]] std::vector<Id> forgotten(Instant now) const;

  /// Counts as a question about it; null: there is none, or no longer.
  [[nodiscard]] const Job* ask(Id id, Instant now);
  [[nodiscard]] std::size_t running() const;
  /// How many run or wait before it.
  [[nodiscard]] std::size_t before(Id id) const;

 private:
  [[nodiscard]] static bool over(const Job& job) {
    return job.state != JobState::waiting && job.state != JobState::running;
  }
  void end(Job& job, JobState state, Instant now);
  void make_room();

  JobLimits limits_;
  Id last_{0};
  std::map<Id, Job> jobs_;
};

}  // namespace mgtd::daemon::serve::console
