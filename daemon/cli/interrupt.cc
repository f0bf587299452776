// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/interrupt.h"

#include <poll.h>

#include <cerrno>
#include <csignal>

namespace mgtd::daemon::cli {
namespace {

volatile std::sig_atomic_t came = 0;

/// The signals of catch_interrupts.
sigset_t& caught() {
  static sigset_t signals = [] {
    sigset_t none;
    sigemptyset(&none);
    return none;
  }();
  return signals;
}

}  // namespace

void catch_interrupts(std::initializer_list<int> signals) {
  struct sigaction action {};
  action.sa_handler = [](int) { came = 1; };
  sigemptyset(&action.sa_mask);
  for (const int signal : signals) {
    // A terminal that is closed sends its signal twice.
    action.sa_flags = signal == SIGINT ? static_cast<int>(SA_RESETHAND) : 0;
    sigaddset(&caught(), signal);
    ::sigaction(signal, &action, nullptr);
  }
}

bool interrupted() { return came != 0; }

bool wait_for_input(int fd) {
  sigset_t before;
  ::pthread_sigmask(SIG_BLOCK, &caught(), &before);
  pollfd readable{fd, POLLIN, 0};
  // Outside of ppoll they are held back, so none comes between the look and the wait.
  while (!interrupted() && ::ppoll(&readable, 1, nullptr, &before) < 0 && errno == EINTR) {
  }
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return !interrupted();
}

}  // namespace mgtd::daemon::cli
