// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/output_file.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <utility>

#include "daemon/store/pose_source.h"
#include "proto/standard_output.h"

namespace mgtd::daemon::cli {
namespace {

/// Writes the content; returns errno if that fails.
std::optional<int> put(const std::string& path, const std::string& content) {
  errno = 0;
  std::ofstream out(path, std::ios::binary | std::ios::trunc);
  if (out << content << std::flush) return std::nullopt;
  return errno;
}

/// Whether the path is a device, a FIFO or a symbolic link, which is written to and stays what it is.
bool stays(const std::string& path) {
  std::error_code ignored;
  const auto own = std::filesystem::symlink_status(path, ignored);
  return std::filesystem::exists(own) && !std::filesystem::is_regular_file(own);
}

}  // namespace

Result<OutputFile> OutputFile::at(std::string path, const std::vector<std::string>& inputs,
                                  std::string option) {
  OutputFile out(std::move(path), std::move(option));
  if (!out.wanted()) return out;
  if (auto apart = out.refuse_input(inputs); !apart) return tl::unexpected(apart.error());
  if (auto apart = out.refuse_run_file(); !apart) return tl::unexpected(apart.error());
  return out;
}

/// A device holds nothing (/dev/null), and only a terminal shows it.
bool OutputFile::is_standard_output() const {
  struct stat named {
  }, printed{};
  if (::stat(path_.c_str(), &named) != 0 || ::fstat(STDOUT_FILENO, &printed) != 0) return false;
  return named.st_dev == printed.st_dev && named.st_ino == printed.st_ino &&
         (!S_ISCHR(printed.st_mode) || ::isatty(STDOUT_FILENO) != 0);
}

Result<void> OutputFile::refuse_input(const std::vector<std::string>& inputs) const {
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(path_, unknown)) return {};
  for (const std::string& input : inputs) {
    if (!std::filesystem::equivalent(path_, input, unknown)) continue;
    return fail(ErrorCode::usage,
                input == path_
                    ? fmt::format("{} {} is the file that is read", option_, path_)
                    : fmt::format("{} {} and {}, which is read, are the same file", option_, path_, input),
                fmt::format("it would be overwritten: give another name with {}", option_));
  }
  return {};
}

Result<void> OutputFile::refuse_run_file() const {
  std::error_code unknown;
  const auto there = std::filesystem::status(path_, unknown);
  const bool exists = std::filesystem::exists(there);
  if (exists && !std::filesystem::is_regular_file(there)) return {};
  if (!store::is_run_file(path_)) return {};
  return fail(ErrorCode::usage,
              exists
                  ? fmt::format("{} {} is a run file, which would be overwritten", option_, path_)
                  : fmt::format("{} {} has the name of a run file, and none is written here", option_, path_),
              fmt::format("give another name with {}; mgt import makes run files", option_));
}

Error OutputFile::cannot_write(int os_error) const {
  return {ErrorCode::io, fmt::format("{} cannot be written: {}", path_, std::strerror(os_error)),
          fmt::format("choose another place with {}", option_)};
}

Result<void> OutputFile::write(const std::string& content, const std::string& what) const {
  if (!wanted()) return {};
  if (is_standard_output()) {
    fmt::print("{}", content);
    end_standard_output();
    tell_written(what, path_);
    return {};
  }
  const std::string written = stays(path_) ? path_ : fmt::format("{}.{}.tmp", path_, getpid());
  auto failed = put(written, content);
  if (written != path_) {
    if (!failed && std::rename(written.c_str(), path_.c_str()) != 0) failed = errno;
    if (failed) std::remove(written.c_str());
  }
  if (failed) return tl::unexpected(cannot_write(*failed));
  tell_written(what, path_);
  return {};
}

void end_standard_output() {
  flush_standard_output();
  ::dup2(STDERR_FILENO, STDOUT_FILENO);
}

void tell_written(const std::string& what, const std::string& path) {
  fmt::print(stderr, "{} written to {}\n", what, path);
}

}  // namespace mgtd::daemon::cli
