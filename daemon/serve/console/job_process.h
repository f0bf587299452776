// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <utility>

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proto/error.h"

/// A JobProcess is one child process that gets its arguments and no descriptor, shell or secret of the
/// daemon; of the environment only what has `mgt` tell its progress line by line. It has a bounded address
/// space and processor time, its output is bounded, it dies with us, and the kernel takes it first where
/// memory runs out. Its end and its output come on the io_context.
namespace mgtd::daemon::serve::console {

struct JobBounds {
  std::uint64_t memory_bytes{0};  ///< of address space; 0: half of this computer's memory
  std::uint64_t processor_s{600};
  std::size_t output_bytes{32'000'000};
};

struct JobEnd {
  int exit_code{-1};  ///< -1: ended by a signal, or by us
  std::string out;    ///< standard output
  std::string why;    ///< in words, where it did not end by itself
};

class JobProcess : public std::enable_shared_from_this<JobProcess> {
 public:
  /// `words`: the program's path and its arguments. `ended` is called once, later, on the io_context.
  [[nodiscard]] static Result<std::shared_ptr<JobProcess>> start(boost::asio::io_context& io,
                                                                 const std::vector<std::string>& words,
                                                                 const JobBounds& bounds,
                                                                 std::function<void(JobEnd)> ended);
  ~JobProcess();
  JobProcess(const JobProcess&) = delete;
  JobProcess& operator=(const JobProcess&) = delete;

  /// Ends it now; `ended` is still called.
  void kill();
  /// What it said last on standard error.
  [[nodiscard]] std::string_view said() const;

 private:
  struct Pipe {
    boost::asio::posix::stream_descriptor end;
    std::array<char, 16'384> bytes{};
    std::string text{};
    bool open{true};
  };
  JobProcess(boost::asio::io_context& io, const JobBounds& bounds, std::function<void(JobEnd)> ended);
  void read(Pipe& pipe, std::size_t limit);
  void wait();
  void finish();

  JobBounds bounds_;
  std::function<void(JobEnd)> ended_;
  Pipe out_, err_;
  boost::asio::posix::stream_descriptor process_;  ///< readable when the process has ended
  int pid_{-1};
  std::optional<int> status_;
  std::string why_;
};

/// Memory of this computer.
[[nodiscard]] std::uint64_t memory_bytes();

}  // namespace mgtd::daemon::serve::console
