// SPDX-License-Identifier: Apache-2.0
#include "daemon/serve/console/job_desk.h"

#include <fmt/format.h>

#include <charconv>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>

#include "daemon/serve/console/job_request.h"
#include "proto/json_line.h"

namespace mgtd::daemon::serve::console {
namespace {

using nlohmann::ordered_json;

constexpr auto kLookForForgotten = std::chrono::seconds(2);
constexpr unsigned kAccepted = 202, kBadRequest = 400, kNotFound = 404, kMethodNotAllowed = 405,
                   kTooMany = 429;

std::string dumped(const ordered_json& object) { return to_line(object) + '\n'; }

JobAnswer refused(unsigned status, const Error& error) {
  return {
      status,
      dumped({{"error",
               {{"code", mgtd::name(error.code)}, {"message", error.message}, {"remedy", error.remedy}}}})};
}

}  // namespace

class JobDesk::State : public std::enable_shared_from_this<State> {
 public:
  State(boost::asio::io_context& io, WorkbenchConfig config)
      : io_(io), config_(std::move(config)), folder_(config_.runs), queue_(config_.limits), timer_(io) {}

  std::string runs() { return to_json(folder_.list()); }

  JobAnswer answer(std::string_view method, std::string_view path, std::string_view body,
                   const std::string& who) {
    if (path == "/jobs") {
      if (method == "POST") return post(body, who);
      return refused(kMethodNotAllowed, {ErrorCode::usage, "/jobs takes POST", ""});
    }
    std::string_view rest = path.substr(std::string_view("/jobs/").size());
    const bool result = rest.ends_with("/result");
    if (result) rest.remove_suffix(std::string_view("/result").size());
    JobQueue::Id id = 0;
    const auto [end, ec] = std::from_chars(rest.data(), rest.data() + rest.size(), id);
    const Job* const job =
        ec == std::errc() && end == rest.data() + rest.size() ? queue_.ask(id, now()) : nullptr;
    if (job == nullptr)
      return refused(kNotFound, {ErrorCode::usage, "there is no such job, or no longer", "ask for it again"});
    if (method == "DELETE" && !result) return cancel(id);
    if (method != "GET")
      return refused(kMethodNotAllowed, {ErrorCode::usage, "a job takes GET and DELETE", ""});
    if (!result) return {.body = described(id, *job)};
    if (job->state == JobState::done) return {.body = job->result, .type = job->task.type};
    return refused(kNotFound, {ErrorCode::state, fmt::format("the job is {}", name(job->state)), job->why});
  }

  void stop() {
    stopped_ = true;
    timer_.cancel();
    for (const auto& [id, process] : processes_) process->kill();
  }

 private:
  [[nodiscard]] Instant now() const { return clock_.now().mono; }

  JobAnswer post(std::string_view body, const std::string& who) {
    if (stopped_) return refused(kBadRequest, {ErrorCode::state, "the server ends", ""});
    const auto request = parse_job_request(body);
    if (!request) return refused(kBadRequest, request.error());
    const auto run = folder_.find(request->run);
    if (!run) return refused(kNotFound, run.error());
    const bool table = run->extension() == ".csv";
    if (table && request->changes() && request->verb->name != "import")
      return refused(kBadRequest, {ErrorCode::usage, request->run + " is a pose table, which keeps no model",
                                   "make a run file of it first"});
    if (table && !request->verb->of_tables)
      return refused(kBadRequest, {ErrorCode::usage,
                                   fmt::format("{} needs a run file, and {} is a pose table",
                                               request->verb->name, request->run),
                                   "make a run file of it first"});
    auto made = *run;
    made.replace_extension(".mgtrun");
    const auto words = [&](const std::string& source, const std::string& target, const std::string& by) {
      return job_words(*request, source, target, config_.model_options, by);
    };
    JobTask task;
    task.command = "mgt " + typed(words(request->run, made.filename().string(), {}));
    task.question = task.command + '\n' + folder_.stamp(request->run);
    task.words = words(run->string(), made.string(), config_.for_others ? who : std::string());
    task.changes = request->changes();
    task.words.insert(task.words.begin(), config_.mgt.string());
    if (request->verb->name == "report") task.type = "text/plain; charset=utf-8";
    const auto id = queue_.put(std::move(task), now());
    if (!id) return refused(kTooMany, id.error());
    begin_next();
    watch();
    return {kAccepted, dumped({{"job", *id}})};
  }

  std::string described(JobQueue::Id id, const Job& job) {
    ordered_json out{{"job", id}, {"state", name(job.state)}, {"command", job.task.command}};
    if (job.state == JobState::waiting) out["before"] = queue_.before(id);
    if (job.begun != Instant{}) out["elapsed_s"] = to_seconds(job.ended.value_or(now()) - job.begun);
    if (const auto process = processes_.find(id); process != processes_.end())
      out["said"] = std::string(process->second->said());
    if (job.state == JobState::done) {
      out["exit_code"] = job.exit_code;
      out["bytes"] = job.result.size();
    }
    if (!job.why.empty()) out["why"] = job.why;
    return dumped(out);
  }

  JobAnswer cancel(JobQueue::Id id) {
    if (const auto process = processes_.find(id); queue_.cancel(id, now()) && process != processes_.end())
      process->second->kill();
    return {.body = dumped({{"job", id}, {"state", "cancelled"}})};
  }

  void begin_next() {
    // One that was ended is waited for.
    while (!stopped_ && processes_.size() == queue_.running()) {
      const auto id = queue_.next(now());
      if (!id) return;
      begin(*id);
    }
  }

  void begin(JobQueue::Id id) {
    auto process = JobProcess::start(io_, queue_.ask(id, now())->task.words, config_.bounds,
                                     [weak = weak_from_this(), id](JobEnd end) {
                                       if (const auto self = weak.lock()) self->ended(id, std::move(end));
                                     });
    if (process)
      processes_.emplace(id, *std::move(process));
    else
      queue_.failed(id, process.error().text(), now());
  }

  void ended(JobQueue::Id id, JobEnd end) {
    processes_.erase(id);
    if (!end.why.empty()) {
      queue_.failed(id, std::move(end.why), now());
    } else {
      queue_.done(id, end.exit_code, std::move(end.out), now());
    }
    begin_next();
  }

  /// While anything is under way: has its page gone?
  void watch() {
    if (watching_ || stopped_) return;
    watching_ = true;
    timer_.expires_after(kLookForForgotten);
    timer_.async_wait([weak = weak_from_this()](boost::system::error_code ec) {
      const auto self = weak.lock();
      if (!self) return;
      self->watching_ = false;
      if (ec) return;
      for (const JobQueue::Id id : self->queue_.forgotten(self->now())) (void)self->cancel(id);
      self->begin_next();
      if (self->queue_.running() > 0) self->watch();
    });
  }

  boost::asio::io_context& io_;
  WorkbenchConfig config_;
  RunFolder folder_;
  JobQueue queue_;
  drivers::Clock clock_;
  boost::asio::steady_timer timer_;
  std::map<JobQueue::Id, std::shared_ptr<JobProcess>> processes_;
  bool watching_{false}, stopped_{false};
};

JobDesk::JobDesk(boost::asio::io_context& io, WorkbenchConfig config)
    : state_(std::make_shared<State>(io, std::move(config))) {}
JobDesk::~JobDesk() { state_->stop(); }
std::string JobDesk::runs() { return state_->runs(); }
JobAnswer JobDesk::answer(std::string_view method, std::string_view path, std::string_view body,
                          const std::string& who) {
  return state_->answer(method, path, body, who);
}
void JobDesk::stop() { state_->stop(); }

std::filesystem::path mgt_beside_us() {
  std::error_code ec;
  return std::filesystem::read_symlink("/proc/self/exe", ec).parent_path() / "mgt";
}

}  // namespace mgtd::daemon::serve::console
