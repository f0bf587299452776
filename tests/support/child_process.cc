// SPDX-License-Identifier: Apache-2.0
#include "tests/support/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>

#include "tests/support/whole_file.h"

namespace mgtd::testing {
namespace {

using Clock = std::chrono::steady_clock;

void redirect(const std::string& path, int to) {
  const int fd = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (fd >= 0) dup2(fd, to);
}

Finished outcome(int status) {
  Finished finished;
  if (WIFEXITED(status)) finished.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) finished.signal = WTERMSIG(status);
  return finished;
}

}  // namespace

ChildProcess::ChildProcess(std::vector<std::string> command, const std::string& dir, const std::string& name)
    : out_path_(dir + "/" + name + ".out"), err_path_(dir + "/" + name + ".err") {
  std::vector<char*> argv;
  for (std::string& word : command) argv.push_back(word.data());
  argv.push_back(nullptr);
  pid_ = fork();
  if (pid_ == 0) {
    redirect(out_path_, STDOUT_FILENO);
    redirect(err_path_, STDERR_FILENO);
    execvp(argv[0], argv.data());
    _exit(127);
  }
}

ChildProcess::~ChildProcess() {
  if (running()) {
    signal(SIGKILL);
    int status = 0;
    waitpid(pid_, &status, 0);
  }
}

bool ChildProcess::running() {
  if (finished_ || pid_ <= 0) return false;
  int status = 0;
  if (waitpid(pid_, &status, WNOHANG) != pid_) return true;
  finished_ = outcome(status);
  return false;
}

void ChildProcess::signal(int number) const {
  if (pid_ > 0) kill(pid_, number);
}

std::optional<Finished> ChildProcess::wait(std::chrono::seconds limit) {
  if (!eventually([this] { return !running(); }, limit)) {
    signal(SIGKILL);
    return std::nullopt;
  }
  finished_->out = out();
  finished_->err = err();
  return finished_;
}

std::string ChildProcess::err() const { return whole_file(err_path_); }
std::string ChildProcess::out() const { return whole_file(out_path_); }

Finished run_program(std::vector<std::string> command, const std::string& dir, std::chrono::seconds limit) {
  ChildProcess child(std::move(command), dir, "program");
  return child.wait(limit).value_or(Finished{});
}

bool eventually(const std::function<bool()>& condition, std::chrono::seconds limit) {
#ifdef MGTD_SANITIZED  // what is waited for is slower, and the tests let it be
  limit *= 5;
#endif
  const auto deadline = Clock::now() + limit;
  while (!condition()) {
    if (Clock::now() > deadline) return false;
    poll(nullptr, 0,
         5);  // yields the processor between two looks; nothing is inferred from the time that passed
  }
  return true;
}

TemporaryDirectory::TemporaryDirectory() {
  std::string pattern = (std::filesystem::temp_directory_path() / "mgtd-test-XXXXXX").string();
  path_ = mkdtemp(pattern.data()) == nullptr ? std::string{} : pattern;
}

TemporaryDirectory::~TemporaryDirectory() {
  std::error_code ignored;
  if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
}

}  // namespace mgtd::testing
