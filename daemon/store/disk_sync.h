// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

#include "daemon/store/journal.h"
#include "daemon/store/worker.h"

/// DiskSync makes the disk finish what journals have written, on a thread of its own, so that a disk that
/// takes seconds delays nobody. Journals outlive it.
namespace mgtd::daemon::store {

class DiskSync {
 public:
  explicit DiskSync(boost::asio::io_context& home) : worker_(home) {}

  void look_after(Journal& journal) {
    for (const int fd : journal.take_syncs()) {
      worker_.run(
          [fd](const std::stop_token&) {
            const int os_error = ::fdatasync(fd) == 0 ? 0 : errno;
            ::close(fd);
            return os_error;
          },
          [&journal](int os_error) { journal.synced(os_error); });
    }
  }

 private:
  Worker worker_;
};

}  // namespace mgtd::daemon::store
