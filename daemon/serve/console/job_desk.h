// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/serve/console/job_process.h"
#include "daemon/serve/console/job_queue.h"
#include "daemon/serve/console/run_folder.h"
#include "drivers/clock.h"

/// The job desk answers the requests of the workbench:
///
///     GET    /runs              run files and pose tables of the folder
///     POST   /jobs              a request (job_request.h): 202 {"job":7}
///     GET    /jobs/7            {"job","state","before","elapsed_s","command","said","exit_code","why"}
///     GET    /jobs/7/result     what the command printed, to the byte
///     DELETE /jobs/7            ends it
///
/// A job is a child process `mgt VERB ... --json` (job_process.h), so the number on the page is the number of
/// the terminal, and nothing that happens in it can disturb who serves it. The desk does not know tokens: its
/// owner lets nobody ask for jobs who has none. Runs on the io_context's thread.
namespace mgtd::daemon::serve::console {

struct WorkbenchConfig {
  std::filesystem::path runs;                ///< folder, or one file (run_folder.h)
  std::filesystem::path mgt;                 ///< the program
  std::vector<std::string> model_options{};  ///< for every job that fits: --field=50000
  bool for_others{false};  ///< the user of the jobs is not who asks: steps are kept under `who`
  JobLimits limits{};
  JobBounds bounds{};
};

struct JobAnswer {
  unsigned status{200};
  std::string body;
  std::string type{"application/json"};
};

class JobDesk {
 public:
  JobDesk(boost::asio::io_context& io, WorkbenchConfig config);
  ~JobDesk();
  JobDesk(const JobDesk&) = delete;
  JobDesk& operator=(const JobDesk&) = delete;

  [[nodiscard]] std::string runs();
  /// `path`: "/jobs" and what is below it; `who` asks, for people: "the console, from 127.0.0.1".
  [[nodiscard]] JobAnswer answer(std::string_view method, std::string_view path, std::string_view body,
                                 const std::string& who);
  /// Ends what runs.
  void stop();

 private:
  class State;
  std::shared_ptr<State> state_;
};

/// `mgt` beside the program that runs.
[[nodiscard]] std::filesystem::path mgt_beside_us();

}  // namespace mgtd::daemon::serve::console
