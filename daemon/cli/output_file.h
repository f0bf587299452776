// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "proto/error.h"

/// An OutputFile is the file that a command writes. It refuses, before anything is computed, a file that the
/// command reads (by this name or another one: a symbolic or a hard link), and a run file, which holds a
/// measurement and is written by `mgt import` and the daemon alone.
namespace mgtd::daemon::cli {

class OutputFile {
 public:
  /// `path` may be empty: nothing is wanted. `inputs`: every file that the command reads; empty ones are
  /// none. `option` gave the path.
  [[nodiscard]] static Result<OutputFile> at(std::string path, const std::vector<std::string>& inputs,
                                             std::string option = "-o");

  [[nodiscard]] bool wanted() const { return !path_.empty(); }
  [[nodiscard]] const std::string& path() const { return path_; }
  /// Whether the path leads where standard output goes: `-o /dev/stdout`, or a file that it is redirected to.
  [[nodiscard]] bool is_standard_output() const;

  /// Writes the whole file by way of a temporary one, so that a failure leaves the old file untouched. A
  /// device, a FIFO or a symbolic link is written to directly and stays what it is. Where the file is
  /// standard output, what is printed from then on goes to standard error instead. Does nothing where nothing
  /// is wanted. Says on stderr that `what` is written, as tell_written() does.
  [[nodiscard]] Result<void> write(const std::string& content, const std::string& what) const;

 private:
  OutputFile(std::string path, std::string option) : path_(std::move(path)), option_(std::move(option)) {}
  [[nodiscard]] Result<void> refuse_input(const std::vector<std::string>& inputs) const;
  [[nodiscard]] Result<void> refuse_run_file() const;
  [[nodiscard]] Error cannot_write(int os_error) const;

  std::string path_, option_;
};

/// Ends what stands in standard output as a file: what is printed from then on goes to standard error.
void end_standard_output();

/// "`what` written to `path`", on stderr: standard output may be that file.
void tell_written(const std::string& what, const std::string& path);

}  // namespace mgtd::daemon::cli
