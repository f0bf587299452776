// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

/// A PtyMaster is the instrument's end of a pseudo-terminal whose other end is found under a path of the
/// test's choice.
namespace mgtd::testing {

class PtyMaster {
 public:
  /// The path becomes a symbolic link to the terminal, as udev makes them.
  explicit PtyMaster(std::string path);
  /// Unplugged: the terminal hangs up, the link is gone.
  ~PtyMaster();
  PtyMaster(const PtyMaster&) = delete;
  PtyMaster& operator=(const PtyMaster&) = delete;

  void write(std::string_view bytes) const;
  /// Everything that has arrived so far.
  [[nodiscard]] const std::string& received();
  /// Name of the terminal itself, /dev/pts/N.
  [[nodiscard]] const std::string& terminal() const { return terminal_; }

 private:
  std::string path_, terminal_, received_;
  int fd_{-1};
};

}  // namespace mgtd::testing
