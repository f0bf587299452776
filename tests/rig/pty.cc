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

bool Pty::make(std::string& terminal) {
  std::array<char, 128> name{};
  int slave = -1;
  if (openpty(&master_, &slave, name.data(), nullptr, nullptr) != 0) {
    why_ = std::string("openpty: ") + std::strerror(errno);
    master_ = -1;
    return false;
  }
  terminal = name.data();
  termios raw{};
  tcgetattr(slave, &raw);
  cfmakeraw(&raw);
  tcsetattr(slave, TCSANOW, &raw);
  fcntl(master_, F_SETFL, fcntl(master_, F_GETFL) | O_NONBLOCK);
  fcntl(master_, F_SETFD, FD_CLOEXEC);
  // From now on a read of the master tells whether anybody else has the other side open. The settings stay
  // with the terminal.
  ::close(slave);
  return true;
}

void Pty::open() {
  std::string terminal;
  if (is_open() || !make(terminal)) return;
  unlink(link_.c_str());
  if (symlink(terminal.c_str(), link_.c_str()) == 0) return;
  why_ = link_ + ": " + std::strerror(errno);
  ::close(master_);
  master_ = -1;
}

void Pty::close() {
  if (!is_open()) return;
  unlink(link_.c_str());
  ::close(master_);
  master_ = -1;
  listened_ = false;
}

std::string Pty::read() {
  std::string out;
  std::array<char, 4096> buffer;
  ssize_t n = 0;
  while (is_open() && (n = ::read(master_, buffer.data(), buffer.size())) > 0)
    out.append(buffer.data(), static_cast<std::size_t>(n));
  listened_ = is_open() && n < 0 && errno == EAGAIN;
  return out;
}

std::size_t Pty::write(std::string_view bytes) {
  if (!is_open() || bytes.empty()) return 0;
  const ssize_t n = ::write(master_, bytes.data(), bytes.size());
  return n > 0 ? static_cast<std::size_t>(n) : 0;
}

}  // namespace mgtd::rig
