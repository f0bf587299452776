// SPDX-License-Identifier: Apache-2.0
#include "daemon/serve/console/job_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <boost/asio/buffer.hpp>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <system_error>

namespace mgtd::daemon::serve::console {
namespace {

using boost::system::error_code;

constexpr std::size_t kMostSaid = 65'536;

/// The sanitizers reserve terabytes of addresses that they do not use.
#ifdef MGTD_SANITIZED
constexpr bool kBoundMemory = false;
#else
constexpr bool kBoundMemory = true;
#endif

tl::unexpected<Error> no_process(int error) {
  return fail(ErrorCode::io, fmt::format("no process could be started: {}", std::strerror(error)),
              "the computer is short of processes, descriptors or memory");
}

struct Pipes {
  int out[2]{-1, -1}, err[2]{-1, -1};
  ~Pipes() {
    for (const int fd : {out[0], out[1], err[0], err[1]})
      if (fd >= 0) ::close(fd);
  }
};

void bound(__rlimit_resource resource, std::uint64_t most, std::uint64_t grace = 0) {
  const rlimit limit{most, most + grace};
  // setrlimit may be forbidden to a service where prlimit is not.
  ::prlimit(0, resource, &limit, nullptr);
}

/// As execve() takes them, null at the end.
std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> out;
  out.reserve(texts.size() + 1);
  for (std::string& text : texts) out.push_back(text.data());
  out.push_back(nullptr);
  return out;
}

/// In the child, between fork and exec: system calls only.
[[noreturn]] void become(const Pipes& pipes, char* const* words, char* const* environment,
                         const JobBounds& bounds, pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(127);
  ::setpgid(0, 0);  // Ctrl-C is for us
  const int nothing = ::open("/dev/null", O_RDONLY);
  if (nothing < 0 || ::dup2(nothing, 0) < 0 || ::dup2(pipes.out[1], 1) < 0 || ::dup2(pipes.err[1], 2) < 0)
    ::_exit(127);
  if (::syscall(SYS_close_range, 3U, ~0U, 0U) != 0)
    for (int fd = 3; fd < 65'536; ++fd) ::close(fd);
  if (kBoundMemory) bound(RLIMIT_AS, bounds.memory_bytes);
  bound(RLIMIT_CPU, bounds.processor_s, 5);
  bound(RLIMIT_CORE, 0);
  if (const int first = ::open("/proc/self/oom_score_adj", O_WRONLY); first >= 0) {
    [[maybe_unused]] const auto written = ::write(first, "500", 3);
    ::close(first);
  }
  [[maybe_unused]] const int kinder = ::nice(10);  // where it is allowed
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  ::signal(SIGPIPE, SIG_DFL);
  ::execve(words[0], words, environment);
  ::_exit(127);
}

std::string in_words(int signal, const JobBounds& bounds) {
  if (signal == SIGXCPU)
    return fmt::format("it took more than {} s of a processor, which is the limit", bounds.processor_s);
  if (signal == SIGABRT || signal == SIGSEGV || signal == SIGKILL)
    return fmt::format("it ended by {}; it may use {} MB of memory", ::strsignal(signal),
                       bounds.memory_bytes / 1'000'000);
  return fmt::format("it ended by {}", ::strsignal(signal));
}

}  // namespace

std::uint64_t memory_bytes() {
  const long pages = ::sysconf(_SC_PHYS_PAGES), page = ::sysconf(_SC_PAGESIZE);
  return pages > 0 && page > 0 ? static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(page) : 0;
}

JobProcess::JobProcess(boost::asio::io_context& io, const JobBounds& bounds,
                       std::function<void(JobEnd)> ended)
    : bounds_(bounds),
      ended_(std::move(ended)),
      out_{.end = boost::asio::posix::stream_descriptor(io)},
      err_{.end = boost::asio::posix::stream_descriptor(io)},
      process_(io) {}

JobProcess::~JobProcess() {
  if (pid_ <= 0 || status_) return;
  ::kill(-pid_, SIGKILL);
  ::kill(pid_, SIGKILL);
  while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) continue;
}

Result<std::shared_ptr<JobProcess>> JobProcess::start(boost::asio::io_context& io,
                                                      const std::vector<std::string>& words,
                                                      const JobBounds& asked,
                                                      std::function<void(JobEnd)> ended) {
  JobBounds bounds = asked;
  if (bounds.memory_bytes == 0) bounds.memory_bytes = memory_bytes() / 2;
  Pipes pipes;
  if (::pipe2(pipes.out, O_CLOEXEC) != 0 || ::pipe2(pipes.err, O_CLOEXEC) != 0) return no_process(errno);
  // Threads of OpenBLAS, which mgt does not use, would take address space and ask for it without end.
  std::vector<std::string> environment{"LC_ALL=C.UTF-8", "NO_COLOR=1", "MGTD_PROGRESS=lines",
                                       "OPENBLAS_NUM_THREADS=1"};
  // The last digits are those of the terminal only with the same kernels of OpenBLAS.
  if (const char* const kernels = std::getenv("OPENBLAS_CORETYPE"))  // NOLINT(concurrency-mt-unsafe)
    environment.push_back(fmt::format("OPENBLAS_CORETYPE={}", kernels));
  std::vector<std::string> held = words;
  const std::vector<char*> argv = pointers(held), envp = pointers(environment);
  std::shared_ptr<JobProcess> out(new JobProcess(io, bounds, std::move(ended)));
  const pid_t parent = ::getpid();
  out->pid_ = ::fork();
  if (out->pid_ < 0) return no_process(errno);
  if (out->pid_ == 0) become(pipes, argv.data(), envp.data(), bounds, parent);
  const int process = static_cast<int>(::syscall(SYS_pidfd_open, out->pid_, 0));
  if (process < 0) return no_process(errno);
  error_code ec;
  out->process_.assign(process, ec);
  out->out_.end.assign(std::exchange(pipes.out[0], -1), ec);
  out->err_.end.assign(std::exchange(pipes.err[0], -1), ec);
  out->read(out->out_, bounds.output_bytes);
  out->read(out->err_, kMostSaid);
  out->wait();
  return out;
}

void JobProcess::read(Pipe& pipe, std::size_t limit) {
  pipe.end.async_read_some(boost::asio::buffer(pipe.bytes), [self = shared_from_this(), &pipe, limit](
                                                                error_code ec, std::size_t n) {
    if (ec) {
      pipe.open = false;
      return self->finish();
    }
    if (&pipe == &self->err_ && pipe.text.size() + n > limit) pipe.text.erase(0, pipe.text.size() / 2);
    if (pipe.text.size() + n <= limit) {
      pipe.text.append(pipe.bytes.data(), n);
    } else {
      self->why_ = fmt::format("it printed more than {} MB, which is the limit", limit / 1'000'000);
      self->kill();
    }
    self->read(pipe, limit);
  });
}

void JobProcess::wait() {
  process_.async_wait(boost::asio::posix::stream_descriptor::wait_read,
                      [self = shared_from_this()](error_code) {
                        int status = 0;
                        while (::waitpid(self->pid_, &status, 0) < 0 && errno == EINTR) continue;
                        self->status_ = status;
                        self->finish();
                      });
}

void JobProcess::kill() {
  if (!status_) ::kill(pid_, SIGKILL);
}

std::string_view JobProcess::said() const {
  std::string_view all = err_.text;
  while (!all.empty() && (all.back() == '\n' || all.back() == '\r')) all.remove_suffix(1);
  const std::size_t at = all.find_last_of("\n\r");
  return at == std::string_view::npos ? all : all.substr(at + 1);
}

void JobProcess::finish() {
  if (!status_ || out_.open || err_.open || !ended_) return;
  JobEnd end{.out = std::move(out_.text), .why = why_};
  if (WIFEXITED(*status_)) {
    end.exit_code = WEXITSTATUS(*status_);
    if (end.exit_code == 127) end.why = "the program mgt beside this one could not be started";
  } else if (end.why.empty()) {
    end.why = in_words(WTERMSIG(*status_), bounds_);
  }
  std::exchange(ended_, nullptr)(std::move(end));
}

}  // namespace mgtd::daemon::serve::console
