// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "proto/error.h"

/// A page asks for a computation in these words:
///
///     {"verb":"add","run":"monday.mgtrun","args":{"effect":"axis.offset.temperature@s3.z","try":true}}
///
/// and the server runs the command `mgt add axis.offset.temperature@s3.z PATH --try --json`. Which verbs
/// there are, which arguments each takes and of which kind is one table; anything that is not in it is
/// refused. No shell is between, a run is a name of the served folder and never a path, and no text of a
/// client can become an option: options carry their value behind '=', and what stands alone may not begin
/// with '-'. Pure.
namespace mgtd::daemon::serve::console {

enum class ArgumentKind {
  run,     ///< the run's path, from the server
  made,    ///< where a run file is made of the pose table: the server's too
  flag,    ///< true or false
  effect,  ///< spec of an effect (calib/effects/effect_spec.h)
  specs,   ///< a list of them: the option again and again
  poses,   ///< a list of pose numbers
  name,    ///< of a formula: letters, digits, '_', '-', '.'
  formula,
  text,  ///< one line
  number,
};

struct JobArgument {
  std::string_view name;  ///< in the request; empty for run and made
  ArgumentKind kind;
  std::string_view option;  ///< "--without"; empty: the argument stands alone
  bool required{false};
};

struct JobVerb {
  std::string_view name;  ///< of the command
  std::span<const JobArgument> arguments;
  std::string_view fixed;          ///< options that the page always wants, with spaces between
  bool changes{false};             ///< writes to the run file, unless it is tried only
  bool of_tables{true};            ///< also on a pose table
  bool takes_model_options{true};  ///< --field and its like, as the server was started with
  bool takes_who{false};           ///< leaves a step in the run file, with who made it
};

[[nodiscard]] std::span<const JobVerb> job_verbs();

struct JobRequest {
  const JobVerb* verb{nullptr};
  std::string run;  ///< name, not yet looked up
  nlohmann::json arguments;

  /// Whether it may write to the run file.
  [[nodiscard]] bool changes() const;
};

/// Refuses what is no object of this shape, unknown verbs and arguments, and values of the wrong kind.
[[nodiscard]] Result<JobRequest> parse_job_request(std::string_view body);

/// The words of the command without the program: verb, what stands alone, options. `run`: the path, or in a
/// command that a person reads, the name; `made`: of the run file that import makes; `who`: makes the step
/// that is kept, empty for the user of the process.
[[nodiscard]] std::vector<std::string> job_words(const JobRequest& request, const std::string& run,
                                                 const std::string& made,
                                                 const std::vector<std::string>& model_options,
                                                 const std::string& who = {});

/// The words as one types them into a shell.
[[nodiscard]] std::string typed(const std::vector<std::string>& words);

}  // namespace mgtd::daemon::serve::console
