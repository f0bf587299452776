// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/types.h>

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

/// A ChildProcess starts, watches and ends a real program under test. A child that outlives its test is
/// killed.
namespace mgtd::testing {

struct Finished {
  int exit_code{-1};  ///< -1 when ended by a signal
  int signal{0};
  std::string out, err;
};

/// A program that runs beside the test; its output goes to files in `dir`.
class ChildProcess {
 public:
  ChildProcess(std::vector<std::string> command, const std::string& dir, const std::string& name);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  [[nodiscard]] bool running();
  void signal(int number) const;
  /// Waits for the end; a child that does not end within the limit is killed and nullopt returned.
  [[nodiscard]] std::optional<Finished> wait(std::chrono::seconds limit = std::chrono::seconds(60));
  [[nodiscard]] std::string err() const;
  [[nodiscard]] std::string out() const;

 private:
  pid_t pid_{-1};
  std::string out_path_, err_path_;
  std::optional<Finished> finished_;
};

/// Runs a program to its end.
[[nodiscard]] Finished run_program(std::vector<std::string> command, const std::string& dir,
                                   std::chrono::seconds limit = std::chrono::seconds(120));

/// Polls a condition until it holds; the limit only ends a test that would hang.
[[nodiscard]] bool eventually(const std::function<bool()>& condition,
                              std::chrono::seconds limit = std::chrono::seconds(60));

/// A fresh directory that is removed with everything in it.
class TemporaryDirectory {
 public:
  TemporaryDirectory();
  ~TemporaryDirectory();
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;
  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] std::string operator/(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

}  // namespace mgtd::testing
