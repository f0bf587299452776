// SPDX-License-Identifier: Apache-2.0
#include "tests/support/on_terminal.h"

#include <poll.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>

namespace mgtd::testing {
namespace {

constexpr unsigned short kRows = 40;

/// What comes from the terminal until its last program is gone. False when that takes too long.
bool read_all(int fd, std::chrono::steady_clock::time_point deadline, std::string& out) {
  std::array<char, 4096> bytes{};
  while (std::chrono::steady_clock::now() < deadline) {
    pollfd wait{fd, POLLIN, 0};
    if (::poll(&wait, 1, 100) <= 0) continue;
    const ssize_t got = ::read(fd, bytes.data(), bytes.size());
    if (got <= 0) return true;  // EIO: nobody has it open any more
    out.append(bytes.data(), static_cast<std::size_t>(got));
  }
  return false;
}

}  // namespace

Finished run_on_terminal(std::vector<std::string> command, unsigned short columns,
                         std::vector<std::string> environment, std::chrono::seconds limit) {
  std::vector<char*> argv;
  for (std::string& word : command) argv.push_back(word.data());
  argv.push_back(nullptr);
  const winsize size{kRows, columns, 0, 0};
  int fd = -1;
  const pid_t pid = forkpty(&fd, nullptr, nullptr, &size);
  if (pid == 0) {
    setenv("TERM", "xterm", 1);
    unsetenv("NO_COLOR");
    for (std::string& variable : environment) putenv(variable.data());
    execvp(argv[0], argv.data());
    _exit(127);
  }
  Finished finished;
  if (pid < 0) return finished;
  if (!read_all(fd, std::chrono::steady_clock::now() + limit, finished.out)) kill(pid, SIGKILL);
  close(fd);
  int status = 0;
  waitpid(pid, &status, 0);
  if (WIFEXITED(status)) finished.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) finished.signal = WTERMSIG(status);
  return finished;
}

}  // namespace mgtd::testing
