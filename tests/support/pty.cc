// SPDX-License-Identifier: Apache-2.0
#include "tests/support/pty.h"

#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <utility>

namespace mgtd::testing {
namespace {

void demand(bool ok, const char* what) {
  if (ok) return;
  std::perror(what);
  std::abort();
}

}  // namespace

PtyMaster::PtyMaster(std::string path) : path_(std::move(path)) {
  fd_ = ::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  demand(fd_ >= 0 && ::grantpt(fd_) == 0 && ::unlockpt(fd_) == 0, "opening a pty");
  std::array<char, 128> name{};
  demand(::ptsname_r(fd_, name.data(), name.size()) == 0, "naming a pty");
  terminal_ = name.data();
  demand(::symlink(terminal_.c_str(), path_.c_str()) == 0, "linking a pty");
}

PtyMaster::~PtyMaster() {
  ::unlink(path_.c_str());
  ::close(fd_);
}

void PtyMaster::write(std::string_view bytes) const {
  demand(::write(fd_, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()), "writing to a pty");
}

const std::string& PtyMaster::received() {
  std::array<char, 4096> chunk{};
  for (ssize_t n = ::read(fd_, chunk.data(), chunk.size()); n > 0;
       n = ::read(fd_, chunk.data(), chunk.size()))
    received_.append(chunk.data(), static_cast<std::size_t>(n));
  return received_;
}

}  // namespace mgtd::testing
