// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <utility>

#include "proto/error.h"

/// The lock makes sure that only one daemon keeps its runs, journals and samples in a folder. A second one
/// that was started by mistake would write gaps of its own between the samples of the first.
///
/// The lock is the kernel's, on the file `lock` in the folder: it ends with the process, however that ends.
namespace mgtd::daemon::store {

class StoreLock {
 public:
  /// Creates the folder when it is missing. Refuses (ErrorCode::state) with the process that has it.
  [[nodiscard]] static Result<StoreLock> take(const std::filesystem::path& folder);

  StoreLock(StoreLock&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  StoreLock& operator=(StoreLock&&) = delete;
  ~StoreLock();

 private:
  explicit StoreLock(int fd) : fd_(fd) {}
  int fd_;
};

}  // namespace mgtd::daemon::store
