// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/pty.h"

#include <fcntl.h>
#include <pty.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

namespace mgtd::rig {

Pty::Pty(std::string link) : link_(std::move(link)) { open(); }

void Pty::open() {
  if (is_open()) return;
  std::array<char, 128> name{};
  if (openpty(&master_, &slave_, name.data(), nullptr, nullptr) != 0) {
    why_ = std::string("openpty: ") + std::strerror(errno);
    master_ = slave_ = -1;
    return;
  }
  termios raw{};
  tcgetattr(slave_, &raw);
  cfmakeraw(&raw);
  tcsetattr(slave_, TCSANOW, &raw);
  fcntl(master_, F_SETFL, fcntl(master_, F_GETFL) | O_NONBLOCK);
  fcntl(master_, F_SETFD, FD_CLOEXEC);
  fcntl(slave_, F_SETFD, FD_CLOEXEC);
  unlink(link_.c_str());
  if (symlink(name.data(), link_.c_str()) != 0) {
    why_ = link_ + ": " + std::strerror(errno);
    close();
  }
}

void Pty::close() {
  if (master_ < 0) return;
  unlink(link_.c_str());
  ::close(slave_);
  ::close(master_);
  master_ = slave_ = -1;
}

std::string Pty::read() {
  std::string out;
  std::array<char, 4096> buffer;
  while (master_ >= 0) {
    const ssize_t n = ::read(master_, buffer.data(), buffer.size());
    if (n <= 0) break;
    out.append(buffer.data(), static_cast<std::size_t>(n));
  }
  return out;
}

std::size_t Pty::write(std::string_view bytes) {
  if (master_ < 0 || bytes.empty()) return 0;
  const ssize_t n = ::write(master_, bytes.data(), bytes.size());
  return n > 0 ? static_cast<std::size_t>(n) : 0;
}

}  // namespace mgtd::rig
