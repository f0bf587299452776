// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/interrupt.h"

#include <csignal>

namespace mgtd::daemon::cli {
namespace {

volatile std::sig_atomic_t came = 0;

}  // namespace

void catch_interrupts(std::initializer_list<int> signals) {
  struct sigaction action {};
  action.sa_handler = [](int) { came = 1; };
  sigemptyset(&action.sa_mask);
  for (const int signal : signals) ::sigaction(signal, &action, nullptr);
}

bool interrupted() { return came != 0; }

}  // namespace mgtd::daemon::cli
