// SPDX-License-Identifier: Apache-2.0
#include "daemon/serve/inherited_sockets.h"

#include <fcntl.h>
#include <sys/socket.h>
#include <systemd/sd-daemon.h>

#include <string>
#include <utility>
#include <vector>

#include "daemon/config/tcp_address.h"

namespace mgtd::daemon::serve {
namespace {

/// Read once: what was given away is not offered again. -1 stands where one was.
std::vector<int>& offered() {
  static std::vector<int> fds = [] {
    std::vector<int> found;
    const int count = sd_listen_fds(0);  // sets close-on-exec
    for (int i = 0; i < count; ++i) {
      const int fd = SD_LISTEN_FDS_START + i;
      ::fcntl(fd, F_SETFL, ::fcntl(fd, F_GETFL) | O_NONBLOCK);
      found.push_back(fd);
    }
    return found;
  }();
  return fds;
}

template <class Matches>
int take(Matches matches) {
  for (int& fd : offered()) {
    if (fd >= 0 && matches(fd)) return std::exchange(fd, -1);
  }
  return -1;
}

}  // namespace

int take_inherited_unix(const std::string& path) {
  return take([&](int fd) { return sd_is_socket_unix(fd, SOCK_STREAM, 1, path.c_str(), 0) > 0; });
}

int take_inherited_tcp(const boost::asio::ip::tcp::endpoint& endpoint) {
  return take([&](int fd) {
    return sd_is_socket_sockaddr(fd, SOCK_STREAM, endpoint.data(), static_cast<unsigned>(endpoint.size()),
                                 1) > 0;
  });
}

}  // namespace mgtd::daemon::serve
