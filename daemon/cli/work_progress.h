// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "calib/fit/fit_options.h"

/// WorkProgress shows on a terminal how long a computation has taken so far and, where it says how much of it
/// is done, how long it will still take; of fits, how many there were and the residual so far. Nothing
/// appears within the first second, nor where stderr is no terminal, and nothing is left on the screen
/// afterwards. With MGTD_PROGRESS=lines in the environment, stderr gets the same as one line every half
/// second instead, whatever it is: so the console, which starts `mgt` for a page, hears how far it is.
namespace mgtd::daemon::cli {

/// What is known of a computation that is under way.
struct WorkState {
  std::string what;                             ///< "explain"
  double elapsed_s{0};                          ///< since it began
  double processor_s{0};                        ///< processor time that this program got in it
  std::optional<double> share;                  ///< of the work that is done, 0 to 1; empty: not known
  int fits{0};                                  ///< that were begun
  std::optional<calib::fit::FitRound> round{};  ///< the last of them has come to
};

/// One line of at most `width` characters:
///   [######..................]  replay  25 % done, 12 s left
///   explain: working for 14 s
///   explain: working for 14 s, fit 23, round 2: residual 0.0412 nT
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
  /// Shows the rounds of the fits that it is told. It may be called after this object is gone.
  [[nodiscard]] calib::fit::RoundListener rounds() const;

 private:
  /// Outlives this object where a result of the work keeps the listener.
  struct Known {
    std::mutex mutex;
    WorkState work;
  };
  void show(const std::stop_token& stop, bool lines);

  std::shared_ptr<Known> known_;
  std::condition_variable_any ended_;
  std::jthread thread_;  ///< last: it uses the others
};

/// The result of `work`, with its progress shown as `what` meanwhile.
template <class Work>
[[nodiscard]] auto with_progress(std::string what, const Work& work) {
  const WorkProgress shown(std::move(what));
  return work();
}

/// The same of work that fits with these options: `work` gets them with a listener that shows the rounds.
template <class Work>
[[nodiscard]] auto with_progress(std::string what, calib::fit::FitOptions options, const Work& work) {
  const WorkProgress shown(std::move(what));
  options.on_round = shown.rounds();
  return work(options);
}

}  // namespace mgtd::daemon::cli
