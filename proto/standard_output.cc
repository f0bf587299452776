// SPDX-License-Identifier: Apache-2.0
#include "proto/standard_output.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <system_error>

namespace mgtd {
namespace {

/// A file that is opened later must not get the number of a standard descriptor that is closed. What is
/// written to standard output is refused all the same.
void hold_closed_descriptors() {
  for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(fd, F_GETFD) < 0)
      (void)::open("/dev/null", fd == STDERR_FILENO ? O_WRONLY : O_RDONLY);  // the lowest free number is fd
}

}  // namespace

void flush_standard_output() {
  if (std::fflush(stdout) != 0) throw std::system_error(errno, std::generic_category());
}

int with_standard_output(std::string_view name, int failed, const std::function<int()>& body) {
  hold_closed_descriptors();
  try {
    const int code = body();
    flush_standard_output();
    return code;
  } catch (const std::system_error& error) {
    if (std::ferror(stderr) != 0) return failed;  // there is nobody to tell
    if (std::ferror(stdout) == 0) throw;
    // Standard error may be full as well, and would throw once more.
    (void)std::fputs(
        fmt::format("{}: cannot write to standard output: {}\n", name, error.code().message()).c_str(),
        stderr);
    return failed;
  }
}

}  // namespace mgtd
