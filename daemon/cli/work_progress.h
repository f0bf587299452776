// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

/// Shows on a terminal how long a computation has taken so far and, where it says how much of it is done, how
/// long it will still take. Nothing appears within the first two seconds, nor where stderr is no terminal,
/// and nothing is left on the screen afterwards.
namespace mgtd::daemon::cli {

/// What is known of a computation that is under way.
struct WorkState {
  std::string what;             ///< "explain"
  double elapsed_s{0};          ///< since it began
  double processor_s{0};        ///< processor time that this program got in it
  std::optional<double> share;  ///< of the work that is done, 0 to 1; empty: not known
};

/// One line of at most `width` characters:
///   [######..................]  replay  25 % done, 12 s left
///   explain: working for 14 s
///   explain: working for 14 s; other programs leave it 8 % of a processor
[[nodiscard]] std::string work_line(const WorkState& work, int width);

class WorkProgress {
 public:
  explicit WorkProgress(std::string what);
  ~WorkProgress();
  WorkProgress(const WorkProgress&) = delete;
  WorkProgress& operator=(const WorkProgress&) = delete;

  /// `share` of the work is done, 0 to 1.
  void done(double share);

 private:
  void show(const std::stop_token& stop);

  WorkState work_;
  std::mutex mutex_;  ///< of work_.share
  std::condition_variable_any ended_;
  std::jthread thread_;  ///< last: it uses the others
};

/// The result of `work`, with its progress shown as `what` meanwhile.
template <class Work>
[[nodiscard]] auto with_progress(std::string what, const Work& work) {
  const WorkProgress shown(std::move(what));
  return work();
}

}  // namespace mgtd::daemon::cli
